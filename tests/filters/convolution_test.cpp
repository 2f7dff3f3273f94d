// filters/convolution: against the double sum that defines it, in exact cases, and the same bits everywhere.

#include "filters/convolution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "core/error.h"
#include "filters/convolution_fft.h"
#include "filters/convolution_lanes.h"

namespace obscura {
namespace {

struct Sizes {
    int width, height, kernel_width, kernel_height;
};

Image<float> noise(int width, int height, unsigned seed, double share = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-1.0f, 1.0f);
    std::bernoulli_distribution lit(share);
    Image<float> image(width, height);
    for (float& v : image.pixels)
        v = lit(random) ? value(random) : 0.0f;
    return image;
}
Image<float> positive_noise(int width, int height, unsigned seed) {
    Image<float> image = noise(width, height, seed);
    for (float& v : image.pixels)
        v = std::fabs(v);
    return image;
}
Image<Vec3f> colour_noise(int width, int height, unsigned seed) {
    Image<Vec3f> image(width, height);
    const Image<float> r = noise(width, height, seed), g = noise(width, height, seed + 1),
                       b = noise(width, height, seed + 2);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = {r.pixels[i], g.pixels[i], b.pixels[i]};
    return image;
}
Image<float> channel_of(const Image<Vec3f>& image, float Vec3f::*channel) {
    Image<float> plane(image.width, image.height);
    for (std::size_t i = 0; i < plane.pixels.size(); ++i)
        plane.pixels[i] = image.pixels[i].*channel;
    return plane;
}

Image<double> double_sum(const Image<float>& source, const Image<float>& kernel) {
    Image<double> out(source.width + kernel.width - 1, source.height + kernel.height - 1);
    for (int y = 0; y < source.height; ++y) {
        for (int x = 0; x < source.width; ++x) {
            for (int v = 0; v < kernel.height; ++v) {
                for (int u = 0; u < kernel.width; ++u)
                    out(x + u, y + v) += static_cast<double>(source(x, y)) * kernel(u, v);
            }
        }
    }
    return out;
}

double norm(const Image<float>& image) {
    double sum = 0;
    for (const float v : image.pixels)
        sum += static_cast<double>(v) * v;
    return std::sqrt(sum);
}
double sum_of(const Image<float>& image) {
    double sum = 0;
    for (const float v : image.pixels)
        sum += v;
    return sum;
}
double largest_error(const Image<float>& image, const Image<double>& expected) {
    EXPECT_EQ(image.width, expected.width);
    EXPECT_EQ(image.height, expected.height);
    double error = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        error = std::max(error, std::fabs(image.pixels[i] - expected.pixels[i]));
    return error;
}

const Sizes cases[] = {
    {1, 1, 1, 1},    {1, 1, 7, 5},   {7, 5, 1, 1},     {17, 1, 3, 1},    {1, 19, 1, 4},    {16, 16, 1, 1},
    {17, 33, 16, 2}, {31, 15, 9, 9}, {20, 20, 45, 63}, {100, 37, 5, 11}, {64, 64, 33, 33}, {3, 90, 40, 2},
};

TEST(Convolution, IsTheDoubleSum) {
    for (const Sizes& s : cases) {
        const Image<float> source = noise(s.width, s.height, 1),
                           kernel = noise(s.kernel_width, s.kernel_height, 2);
        const Image<double> expected = double_sum(source, kernel);
        const double tolerance = 5e-7 * norm(source) * norm(kernel);
        const Exec exec{best_isa(), 2};
        EXPECT_LE(largest_error(convolve_fft(source.view(), kernel.view(), exec), expected), tolerance)
            << s.width << " x " << s.height << " by " << s.kernel_width << " x " << s.kernel_height;
        EXPECT_LE(largest_error(convolve_splats(source.view(), kernel.view(), exec), expected), tolerance)
            << s.width << " x " << s.height << " by " << s.kernel_width << " x " << s.kernel_height;
    }
}

/// Whatever tiles the plan might have chosen, one or many, odd and even numbers of them.
TEST(Convolution, AnyTilesGiveTheDoubleSum) {
    const Image<float> source = noise(75, 58, 3), kernel = noise(13, 22, 4);
    const Image<double> expected = double_sum(source, kernel);
    const double tolerance = 5e-7 * norm(source) * norm(kernel);
    for (int bx = 4; bx <= 7; ++bx) {
        for (int by = 5; by <= 7; ++by) {
            ConvolutionPlan plan;
            plan.log2_x = bx;
            plan.log2_y = by;
            const int x_valid = (1 << bx) - 12, y_valid = (1 << by) - 21;
            plan.tiles_x = bx == 7 ? 1 : (87 + x_valid - 1) / x_valid;
            plan.tiles_y = by == 7 ? 1 : (79 + y_valid - 1) / y_valid;
            Image<float> out(87, 79);
            const ChannelConvolution channel{{source.pixels.data(), 75, 58, 1, 75},
                                             {kernel.pixels.data(), 13, 22, 1, 13},
                                             {out.pixels.data(), 87, 79, 1, 87}};
            convolve_tiles({&channel, 1}, plan, {best_isa(), 1});
            EXPECT_LE(largest_error(out, expected), tolerance) << "2^" << bx << " x 2^" << by;
        }
    }
}

TEST(Convolution, OnePixelLeavesTheKernel) {
    const Image<float> kernel = noise(41, 23, 5);
    Image<float> source(70, 50);
    source(69, 0) = 2.0f;
    const Exec exec{best_isa(), 1};
    const Image<float> splat = convolve_splats(source.view(), kernel.view(), exec),
                       fft = convolve_fft(source.view(), kernel.view(), exec);
    for (int y = 0; y < splat.height; ++y) {
        for (int x = 0; x < splat.width; ++x) {
            const bool inside = x >= 69 && y < 23;
            const float expected = inside ? 2.0f * kernel(x - 69, y) : 0.0f;
            ASSERT_EQ(splat(x, y), expected) << x << ", " << y;
            ASSERT_NEAR(fft(x, y), expected, 1e-5) << x << ", " << y;
        }
    }
}

TEST(Convolution, KeepsTheSum) {
    for (const Sizes& s : {Sizes{300, 200, 65, 129}, Sizes{31, 15, 9, 9}, Sizes{64, 500, 200, 3}}) {
        const Image<float> source = positive_noise(s.width, s.height, 6),
                           kernel = positive_noise(s.kernel_width, s.kernel_height, 7);
        const double expected = sum_of(source) * sum_of(kernel);
        const Exec exec{best_isa(), 2};
        EXPECT_NEAR(sum_of(convolve_fft(source.view(), kernel.view(), exec)) / expected, 1, 1e-6);
        EXPECT_NEAR(sum_of(convolve_splats(source.view(), kernel.view(), exec)) / expected, 1, 1e-6);
    }
}

TEST(Convolution, ViewsMayHaveStrides) {
    const Image<float> source = noise(50, 40, 8), kernel = noise(20, 20, 9);
    const ImageView<const float> part = source.view().crop(7, 3, 33, 30),
                                 core = kernel.view().crop(2, 5, 9, 11);
    Image<float> own_part(33, 30), own_core(9, 11);
    for (int y = 0; y < 30; ++y)
        std::copy_n(part.row(y), 33, own_part.row(y));
    for (int y = 0; y < 11; ++y)
        std::copy_n(core.row(y), 9, own_core.row(y));
    const Exec exec{best_isa(), 1};
    EXPECT_EQ(convolve_fft(part, core, exec), convolve_fft(own_part.view(), own_core.view(), exec));
    EXPECT_EQ(convolve_splats(part, core, exec), convolve_splats(own_part.view(), own_core.view(), exec));
}

TEST(Convolution, ColoursGoChannelByChannel) {
    const Image<Vec3f> source = colour_noise(60, 45, 10), kernel = colour_noise(21, 34, 20);
    const Exec exec{best_isa(), 2};
    const Image<Vec3f> fft = convolve_fft(source.view(), kernel.view(), exec),
                       splats = convolve_splats(source.view(), kernel.view(), exec);
    for (float Vec3f::*channel : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
        const Image<float> plane = channel_of(source, channel), core = channel_of(kernel, channel);
        EXPECT_EQ(channel_of(fft, channel), convolve_fft(plane.view(), core.view(), exec));
        EXPECT_EQ(channel_of(splats, channel), convolve_splats(plane.view(), core.view(), exec));
    }
}

TEST(Convolution, TilesWithoutSourcesAreExactlyZero) {
    Image<float> source(2000, 40);
    source(1990, 20) = 1.0f;
    const Image<float> kernel = noise(9, 9, 11);
    ASSERT_GT(plan_convolution(1, 2000, 40, 9, 9).tiles_x, 8);
    const Image<float> out = convolve_fft(source.view(), kernel.view(), {best_isa(), 1});
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < 1000; ++x)
            ASSERT_EQ(out(x, y), 0.0f);
    }
    EXPECT_NEAR(out(1994, 24), kernel(4, 4), 1e-6);
}

TEST(Convolution, ThreadsAndInstructionSetsChangeNoBit) {
    for (const Sizes& s : {Sizes{130, 70, 31, 9}, Sizes{700, 300, 17, 17}, Sizes{50, 50, 120, 90}}) {
        const Image<float> source = noise(s.width, s.height, 12, 0.1),
                           kernel = noise(s.kernel_width, s.kernel_height, 13);
        const Image<float> fft = convolve_fft(source.view(), kernel.view(), {Isa::ref, 1}),
                           splats = convolve_splats(source.view(), kernel.view(), {Isa::ref, 1});
        for (const Isa isa : supported_isas()) {
            for (const int threads : {1, 2, 7}) {
                const Image<float> f = convolve_fft(source.view(), kernel.view(), {isa, threads}),
                                   p = convolve_splats(source.view(), kernel.view(), {isa, threads});
                EXPECT_EQ(std::memcmp(f.pixels.data(), fft.pixels.data(), 4 * fft.pixels.size()), 0)
                    << isa_name(isa) << ", " << threads << " threads";
                EXPECT_EQ(std::memcmp(p.pixels.data(), splats.pixels.data(), 4 * splats.pixels.size()), 0)
                    << isa_name(isa) << ", " << threads << " threads";
            }
        }
    }
}

TEST(Convolution, BlocksAreTransposed) {
    alignas(64) float from[3 * 512], to[3 * 256];
    for (const Isa isa : supported_isas()) {
        for (int i = 0; i < 3 * 512; ++i)
            from[i] = static_cast<float>(i);
        OBSCURA_DISPATCH(isa, transpose_blocks, from, 512, to, 256, 3);
        for (int block = 0; block < 3; ++block) {
            for (int y = 0; y < 16; ++y) {
                for (int x = 0; x < 16; ++x)
                    ASSERT_EQ(to[256 * block + 16 * x + y], from[512 * block + 16 * y + x]) << isa_name(isa);
            }
        }
    }
}

TEST(ConvolutionPlan, SwitchesWithTheNumberOfSources) {
    EXPECT_FALSE(plan_convolution(1, 1920, 1080, 512, 512).fft);
    EXPECT_FALSE(plan_convolution(100, 1920, 1080, 255, 255).fft);
    EXPECT_TRUE(plan_convolution(1920 * 1080, 1920, 1080, 255, 255).fft);
    // Once only, and at the costs it states.
    bool was = false;
    for (std::int64_t sources = 1; sources < 2'000'000; sources *= 2) {
        const ConvolutionPlan plan = plan_convolution(sources, 1920, 1080, 255, 255);
        EXPECT_EQ(plan.fft, plan.fft_ms < plan.splat_ms);
        EXPECT_GE(plan.fft, was) << sources;
        was = plan.fft;
    }
}

TEST(ConvolutionPlan, ChoosesEachAxisForItself) {
    const ConvolutionPlan wide = plan_convolution(0, 1000, 10, 15, 3);
    EXPECT_EQ(wide.log2_y, 4);
    EXPECT_EQ(wide.tiles_y, 1);
    EXPECT_GT(wide.log2_x, 4);
    // A little more than a power of two is not paid for twice on either axis.
    const ConvolutionPlan plan = plan_convolution(0, 1920, 1080, 513, 513);
    const double area = static_cast<double>(std::int64_t{1} << (plan.log2_x + plan.log2_y));
    EXPECT_LT(area * ((plan.tiles_x * plan.tiles_y + 1) / 2), 4096.0 * 2048);
    // Tiles cover the result.
    for (const Sizes& s : cases) {
        const ConvolutionPlan p = plan_convolution(0, s.width, s.height, s.kernel_width, s.kernel_height);
        const int x_valid = (1 << p.log2_x) - (p.tiles_x > 1 ? s.kernel_width - 1 : 0);
        const int y_valid = (1 << p.log2_y) - (p.tiles_y > 1 ? s.kernel_height - 1 : 0);
        EXPECT_GE(p.tiles_x * x_valid, s.width + s.kernel_width - 1);
        EXPECT_GE(p.tiles_y * y_valid, s.height + s.kernel_height - 1);
        EXPECT_GT(p.fft_bytes, 0);
    }
}

TEST(ConvolutionPlan, KernelsBeyondTheTransformsAreRefused) {
    EXPECT_THROW(plan_convolution(1, 10, 10, 65537, 3), LimitError);
    EXPECT_NO_THROW(plan_convolution(1, 10, 10, 3, 65536));
}

}  // namespace
}  // namespace obscura
