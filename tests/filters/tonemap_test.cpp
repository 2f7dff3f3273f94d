// Codes against their definition: at every threshold and one float below it, everywhere else by monotony.

#include "filters/tonemap.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "core/color.h"

namespace obscura {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

long double srgb_encode_exact(long double x) {
    return x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
}

long double filmic_exact(long double x) {
    return std::min(1.0L, x * (2.51L * x + 0.03L) / (x * (2.43L * x + 0.59L) + 0.14L));
}

/// The least float with code c or more, by bisection over the bits.
template <class Code>
float first_with(int c, Code code) {
    std::uint32_t low = 0, high = 0x7f800000u;  // 0 and infinity
    while (low + 1 < high) {
        const std::uint32_t middle = (low + high) / 2;
        (code(std::bit_cast<float>(middle)) >= c ? high : low) = middle;
    }
    return std::bit_cast<float>(high);
}

template <class Exact, class Code>
void expect_thresholds(Exact encoded, Code code) {
    for (int c = 1; c <= 255; ++c) {
        const float at = first_with(c, code), below = std::nextafter(at, 0.0f);
        EXPECT_EQ(code(at), c);
        EXPECT_EQ(code(below), c - 1);
        EXPECT_GE(255 * encoded(at), c - 0.5L) << c;
        EXPECT_LT(255 * encoded(below), c - 0.5L) << c;
        EXPECT_EQ(code(std::nextafter(at, inf)), c);
    }
}

TEST(Srgb, EveryThresholdIsTheFirstFloatOfItsCode) {
    expect_thresholds(srgb_encode_exact, [](float x) { return linear_to_srgb8(x); });
}

TEST(Srgb, CodesNeverFallOverSixteenMillionFloats) {
    const CodeTable& table = linear_to_srgb8_table();
    int last = 0;
    std::size_t steps = 0;
    for (std::uint32_t bits = 0; bits <= 0x3f800000u; bits += 61) {
        const int c = table(std::bit_cast<float>(bits));
        ASSERT_GE(c, last);
        ASSERT_LE(c, last + 1);
        steps += c != last;
        last = c;
    }
    EXPECT_EQ(steps, 255u);
}

TEST(Srgb, CodesSurviveTheRoundTrip) {
    for (int c = 0; c < 256; ++c) {
        const auto code = static_cast<std::uint8_t>(c);
        EXPECT_EQ(linear_to_srgb8(srgb8_to_linear(code)), c);
        EXPECT_NEAR(srgb8_to_linear(code),
                    c <= 10 ? c / 255.0 / 12.92 : std::pow((c / 255.0 + 0.055) / 1.055, 2.4), 1e-7);
    }
    EXPECT_EQ(srgb8_to_linear(0), 0.0f);
    EXPECT_EQ(srgb8_to_linear(255), 1.0f);
    for (double v = 0; v <= 1; v += 1.0 / 512)
        EXPECT_NEAR(srgb_encode(srgb_decode(v)), v, 1e-6);
}

TEST(Srgb, OutsideTheRangeIsClamped) {
    for (const float x : {-inf, -1.0f, -0.0f, 0.0f, 1e-30f, nan, -nan})
        EXPECT_EQ(linear_to_srgb8(x), 0) << x;
    for (const float x : {1.0f, 1.5f, 1e30f, inf})
        EXPECT_EQ(linear_to_srgb8(x), 255) << x;
    EXPECT_EQ(linear_to_srgb8(0.5f), 188);
}

TEST(Tonemap, FilmicThresholdsAreExact) {
    const ToneParams params{0.0, ToneCurve::filmic};
    expect_thresholds([](long double x) { return srgb_encode_exact(filmic_exact(x)); },
                      [&](float x) {
                          return tonemap({x, 0, 0}, params).r;
                      });
}

TEST(Tonemap, CurvesRiseFromBlackToWhite) {
    for (const ToneCurve curve : {ToneCurve::linear, ToneCurve::filmic}) {
        EXPECT_EQ(tone_curve(curve, 0.0), 0.0);
        EXPECT_EQ(tone_curve(curve, 1e30), 1.0);
        EXPECT_EQ(tone_curve(curve, std::numeric_limits<double>::infinity()), 1.0);
        for (double x = 0; x < 10; x += 0.001)
            EXPECT_LE(tone_curve(curve, x), tone_curve(curve, x + 0.001));
    }
    EXPECT_NEAR(tone_curve(ToneCurve::filmic, 1.0), 2.54 / 3.16, 1e-12);
}

TEST(Tonemap, ExposureIsInStops) {
    const ToneParams up{2.0, ToneCurve::linear}, none{0.0, ToneCurve::linear};
    for (float x = 0; x < 0.3f; x += 0.01f)
        EXPECT_EQ(tonemap({x, x, x}, up), tonemap({4 * x, 4 * x, 4 * x}, none));
}

TEST(Tonemap, RowsAndPicturesEqualTheSinglePixel) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> exponent(-14, 5);
    Image<Vec3f> image(131, 40);
    for (Vec3f& p : image.pixels) {
        p = {std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random))};
    }
    image(0, 0) = {nan, inf, -inf};
    image(1, 0) = {-1, -0.0f, 1e38f};
    for (const ToneParams params :
         {ToneParams{0.0, ToneCurve::linear}, {-1.3, ToneCurve::filmic}, {9.0, ToneCurve::filmic}}) {
        const Image<Rgb8> picture = tonemap(image.view(), params, Exec{Isa::ref, 1});
        EXPECT_EQ(picture, tonemap(image.view(), params, Exec{Isa::ref, 7}));
        for (int y = 0; y < image.height; ++y) {
            std::vector<float> r, g, b;
            for (int x = 0; x < image.width; ++x) {
                ASSERT_EQ(picture(x, y), tonemap(image(x, y), params));
                r.push_back(image(x, y).x), g.push_back(image(x, y).y), b.push_back(image(x, y).z);
            }
            std::vector<Rgb8> row(r.size());
            tonemap_row(r.data(), g.data(), b.data(), image.width, params, row.data());
            ASSERT_TRUE(std::equal(row.begin(), row.end(), picture.row(y)));
        }
    }
    EXPECT_EQ(tonemap({nan, inf, -inf}, {}), (Rgb8{0, 255, 0}));
}

}  // namespace
}  // namespace obscura
