// Difference measures against their definitions written out, on pictures small enough to do so.

#include "filters/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace obscura {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
const Exec one{Isa::ref, 1};

Image<float> noise(int width, int height, unsigned seed, float low = 0, float high = 255) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(low, high);
    Image<float> image(width, height);
    for (float& v : image.pixels)
        v = std::floor(value(random));
    return image;
}

/// SSIM straight from the paper: full 2-D window, central moments in long double.
double ssim_by_definition(const Image<float>& a, const Image<float>& b, double peak, int size_x, int size_y) {
    long double total = 0;
    int windows = 0;
    for (int y0 = 0; y0 + size_y <= a.height; ++y0) {
        for (int x0 = 0; x0 + size_x <= a.width; ++x0) {
            long double weight_sum = 0, mean_a = 0, mean_b = 0, var_a = 0, var_b = 0, covariance = 0;
            const auto weight = [&](int x, int y) {
                const long double dx = x - size_x / 2, dy = y - size_y / 2;
                return std::exp(-(dx * dx + dy * dy) / (2 * 1.5L * 1.5L));
            };
            for (int y = 0; y < size_y; ++y) {
                for (int x = 0; x < size_x; ++x) {
                    weight_sum += weight(x, y);
                    mean_a += weight(x, y) * a(x0 + x, y0 + y);
                    mean_b += weight(x, y) * b(x0 + x, y0 + y);
                }
            }
            mean_a /= weight_sum, mean_b /= weight_sum;
            for (int y = 0; y < size_y; ++y) {
                for (int x = 0; x < size_x; ++x) {
                    const long double da = a(x0 + x, y0 + y) - mean_a, db = b(x0 + x, y0 + y) - mean_b;
                    var_a += weight(x, y) / weight_sum * da * da;
                    var_b += weight(x, y) / weight_sum * db * db;
                    covariance += weight(x, y) / weight_sum * da * db;
                }
            }
            const long double c1 = 0.0001L * peak * peak, c2 = 0.0009L * peak * peak;
            total += (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
                     ((mean_a * mean_a + mean_b * mean_b + c1) * (var_a + var_b + c2));
            ++windows;
        }
    }
    return static_cast<double>(total / windows);
}

TEST(Ssim, EqualsTheDefinition) {
    const Image<float> a = noise(31, 23, 1);
    Image<float> b = a;
    for (std::size_t i = 0; i < b.pixels.size(); i += 3)
        b.pixels[i] = 255 - b.pixels[i];
    EXPECT_NEAR(structural_similarity(a, b, 255, one), ssim_by_definition(a, b, 255, 11, 11), 1e-10);
    EXPECT_LT(structural_similarity(a, b, 255, one), 0.9);
    const Image<float> c = noise(6, 40, 2), d = noise(6, 40, 3);
    EXPECT_NEAR(structural_similarity(c, d, 255, one), ssim_by_definition(c, d, 255, 5, 11), 1e-10);
}

TEST(Ssim, KnownValues) {
    const Image<float> a = noise(20, 20, 1);
    EXPECT_NEAR(structural_similarity(a, a, 255, one), 1.0, 1e-12);
    // Two flat pictures: only the luminance term is left.
    const Image<float> dark(15, 15, 100.0f), light(15, 15, 150.0f);
    const double c1 = 6.5025;
    EXPECT_NEAR(structural_similarity(dark, light, 255, one),
                (2 * 100.0 * 150 + c1) / (100.0 * 100 + 150.0 * 150 + c1), 1e-9);
    EXPECT_NEAR(structural_similarity(Image<float>(1, 1, 7.0f), Image<float>(1, 1, 7.0f), 255, one), 1.0,
                1e-12);
}

TEST(Metrics, NumbersOfAHandMadePair) {
    Planes a(3, Image<float>(4, 2, 10.0f)), b = a;
    b[1](2, 1) = 13;  // 3
    b[2](2, 1) = 6;   // 4
    b[0](3, 0) = 11;  // 1
    const ImageDifference d = compare_images(a, b, {255, 1.0}, one);
    EXPECT_EQ(d.max_error, 4);
    EXPECT_EQ(d.max_x, 2);
    EXPECT_EQ(d.max_y, 1);
    EXPECT_DOUBLE_EQ(d.mean_error, 8.0 / 24);
    EXPECT_NEAR(d.psnr_db, 10 * std::log10(255.0 * 255 / (26.0 / 24)), 1e-9);
    EXPECT_EQ(d.pixels_over, 1);
    EXPECT_EQ(d.first_x, 2);
    EXPECT_EQ(d.first_y, 1);
    EXPECT_EQ(compare_images(a, b, {255, 0.0}, one).pixels_over, 2);
    EXPECT_EQ(compare_images(a, b, {255, 0.0}, one).first_x, 3);
}

TEST(Metrics, OfEqualErrorsTheFirstIsNamed) {
    Planes a{Image<float>(5, 4, 0.0f)}, b = a;
    b[0](3, 1) = b[0](4, 1) = b[0](1, 2) = 7;
    const ImageDifference d = compare_images(a, b, {}, one);
    EXPECT_EQ(d.max_x, 3);
    EXPECT_EQ(d.max_y, 1);
    EXPECT_EQ(d.pixels_over, 3);
}

TEST(Metrics, EqualPicturesDoNotDiffer) {
    const Planes a{noise(30, 30, 4)};
    const ImageDifference d = compare_images(a, a, {}, one);
    EXPECT_EQ(d.max_error, 0);
    EXPECT_EQ(d.mean_error, 0);
    EXPECT_EQ(d.psnr_db, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(d.ssim, 1, 1e-12);
    EXPECT_EQ(d.pixels_over, 0);
    EXPECT_EQ(d.first_x, -1);
}

TEST(Metrics, NonFiniteValuesDifferUnlessTheyAreTheSame) {
    const auto error = [](float x, float y) {
        return compare_images({Image<float>(1, 1, x)}, {Image<float>(1, 1, y)}, {}, one).max_error;
    };
    EXPECT_EQ(error(nan, nan), 0);
    EXPECT_EQ(error(inf, inf), 0);
    EXPECT_EQ(error(inf, -inf), inf);
    EXPECT_EQ(error(1, nan), inf);
    EXPECT_EQ(error(nan, inf), inf);
    EXPECT_EQ(error(inf, 1), inf);
    EXPECT_GT(error(3e38f, -3e38f), 3e38);
    EXPECT_EQ(value_range({Image<float>(1, 1, inf), Image<float>(1, 1, 2.0f), Image<float>(1, 1, -3.0f)}), 5);
}

TEST(Metrics, MeansAndSsimLeaveOutWhatIsNotFinite) {
    // Two depth pictures whose left third is sky, one of which lost a pixel to it.
    Image<float> depth = noise(60, 40, 5);
    for (int y = 0; y < 40; ++y)
        std::fill_n(depth.row(y), 20, inf);
    const Planes a{depth};
    ImageDifference d = compare_images(a, a, {}, one);
    EXPECT_EQ(d.max_error, 0);
    EXPECT_EQ(d.psnr_db, inf);
    EXPECT_NEAR(d.ssim, 1, 1e-12);
    EXPECT_EQ(d.not_finite, 20 * 40);

    Planes b = a;
    b[0](55, 35) += 6;
    d = compare_images(a, b, {}, one);
    EXPECT_NEAR(d.mean_error, 6.0 / (40 * 40), 1e-9);
    EXPECT_LT(d.ssim, 1);
    EXPECT_GT(d.ssim, 0.9);
    b[0](50, 5) = inf;
    d = compare_images(a, b, {255, 1e30}, one);
    EXPECT_EQ(d.max_error, inf);
    EXPECT_EQ(d.max_x, 50);
    EXPECT_EQ(d.pixels_over, 1);
    EXPECT_NEAR(d.mean_error, 6.0 / (40 * 40 - 1), 1e-9);
    EXPECT_TRUE(std::isfinite(d.ssim));

    // The finite part alone says the same.
    Image<float> right(40, 40), right_b(40, 40);
    for (int y = 0; y < 40; ++y) {
        std::copy_n(a[0].row(y) + 20, 40, right.row(y));
        std::copy_n(b[0].row(y) + 20, 40, right_b.row(y));
    }
    EXPECT_EQ(compare_images({right}, {right_b}, {}, one).ssim, d.ssim);

    const Planes sky{Image<float>(9, 9, inf)}, hole{Image<float>(9, 9, nan)};
    EXPECT_EQ(compare_images(sky, sky, {}, one).ssim, 1);
    EXPECT_EQ(compare_images(sky, hole, {}, one).ssim, 0);
    EXPECT_EQ(compare_images(sky, hole, {}, one).mean_error, 0);
}

TEST(Metrics, ThreadsDoNotChangeABit) {
    const Planes a{noise(150, 333, 1), noise(150, 333, 2)}, b{noise(150, 333, 3), noise(150, 333, 4)};
    const ImageDifference d = compare_images(a, b, {255, 9}, one);
    for (const int threads : {2, 3, 7}) {
        const ImageDifference e = compare_images(a, b, {255, 9}, Exec{Isa::ref, threads});
        EXPECT_EQ(d.mean_error, e.mean_error);
        EXPECT_EQ(d.psnr_db, e.psnr_db);
        EXPECT_EQ(d.ssim, e.ssim);
        EXPECT_EQ(d.pixels_over, e.pixels_over);
        EXPECT_EQ(d.max_x, e.max_x);
        EXPECT_EQ(d.max_y, e.max_y);
    }
}

TEST(Metrics, DifferencePictureIsBlackWhereEqualAndWhiteAtFullScale) {
    Planes a{Image<float>(4, 1, 0.0f)}, b = a;
    b[0].pixels = {0, 5, 10, inf};
    const Image<Rgb8> picture = difference_picture(a, b, 10);
    EXPECT_EQ(picture(0, 0), (Rgb8{0, 0, 0}));
    EXPECT_EQ(picture(1, 0), (Rgb8{215, 40, 60}));
    EXPECT_EQ(picture(2, 0), (Rgb8{255, 255, 255}));
    EXPECT_EQ(picture(3, 0), (Rgb8{255, 255, 255}));
}

TEST(Metrics, ChannelsOfAPngAreItsCodes) {
    Image<Rgba8> image(2, 1);
    image(1, 0) = {1, 2, 3, 4};
    const Planes planes = split_channels(image.view(), true);
    ASSERT_EQ(planes.size(), 4u);
    for (int c = 0; c < 4; ++c)
        EXPECT_EQ(planes[static_cast<std::size_t>(c)](1, 0), static_cast<float>(c + 1));
    EXPECT_EQ(split_channels(image.view(), false).size(), 3u);
}

}  // namespace
}  // namespace obscura
