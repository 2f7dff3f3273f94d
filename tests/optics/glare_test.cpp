// Glare: what pixels brighter than the clip level spread, how much of it stays, and that nothing else moves.

#include "optics/glare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/isa.h"
#include "filters/convolution.h"
#include "optics/glare_bloom.h"
#include "tests/optics/glare_pictures.h"

namespace obscura {
namespace {

/// By definition, in double.
Image<Vec3d> oracle(const Image<Vec3f>& picture, const Image<Vec3f>& kernel, float clip) {
    Image<Vec3d> out(picture.width, picture.height);
    const int r = kernel.width / 2;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const double t = std::clamp<double>((largest(picture(x, y)) - clip) / clip, 0, 1),
                         share = t * t * (3 - 2 * t);
            const Vec3d light = to_double(picture(x, y)) * share;
            out(x, y) = out(x, y) + to_double(picture(x, y)) * (1 - share);
            for (int v = std::max(0, y - r); v <= std::min(picture.height - 1, y + r); ++v) {
                for (int u = std::max(0, x - r); u <= std::min(picture.width - 1, x + r); ++u)
                    out(u, v) = out(u, v) + light * to_double(kernel(u - x + r, v - y + r));
            }
        }
    }
    return out;
}

double largest_difference(const Image<Vec3f>& a, const Image<Vec3d>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Vec3d d = to_double(a.pixels[i]) - b.pixels[i];
        most = std::max({most, std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    }
    return most;
}

TEST(Glare, NothingClipsNothingChanges) {
    const Image<Vec3f> picture = night(40, 30, 0, 7);
    GlareReport report;
    const Image<Vec3f> out = add_glare(picture.view(), random_kernel(9, 1), {}, {}, &report);
    EXPECT_TRUE(out == picture);
    EXPECT_EQ(report.sources, 0);
    EXPECT_EQ(report.cost_ms, 0);
    EXPECT_NE(report.reason.find("nothing is computed"), std::string::npos) << report.reason;
}

TEST(Glare, PixelsAtTheClipLevelDoNotGlare) {
    Image<Vec3f> picture(5, 5);
    picture(2, 2) = {1, 0.5f, 0.25f};
    EXPECT_TRUE(add_glare(picture.view(), random_kernel(3, 1), {.clip = 1}, {}) == picture);
    EXPECT_FALSE(add_glare(picture.view(), random_kernel(3, 1), {.clip = 0.99}, {}) == picture);
}

TEST(Glare, OneBrightPixelShowsTheKernel) {
    const Image<Vec3f> kernel = random_kernel(15, 3);
    Image<Vec3f> picture(31, 31);
    picture(17, 13) = {8, 4, 2};
    GlareReport report;
    const Image<Vec3f> out = add_glare(picture.view(), kernel, {}, {}, &report);
    EXPECT_FALSE(report.fft) << report.reason;
    for (int y = 0; y < 31; ++y) {
        for (int x = 0; x < 31; ++x) {
            const int u = x - 17 + 7, v = y - 13 + 7;
            const bool inside = u >= 0 && v >= 0 && u < 15 && v < 15;
            const Vec3f k = inside ? kernel(u, v) : Vec3f{};
            ASSERT_EQ(out(x, y), (Vec3f{8 * k.x, 4 * k.y, 2 * k.z})) << x << " " << y;
        }
    }
    EXPECT_EQ(report.sources, 1);
    EXPECT_NEAR(report.lost, 0, 1e-7);
}

TEST(Glare, ADeltaKernelIsTheIdentity) {
    Image<Vec3f> delta(7, 7);
    delta(3, 3) = {1, 1, 1};
    const Image<Vec3f> picture = night(50, 40, 20, 5);
    GlareReport report;
    const Image<Vec3f> out = add_glare(picture.view(), delta, {}, {}, &report);
    EXPECT_LT(largest_difference(out, oracle(picture, delta, 1)), 1e-4);
    EXPECT_NEAR(report.spread, 0, 1e-6);
    const Image<Vec3f> few = night(50, 40, 1, 5);
    EXPECT_TRUE(add_glare(few.view(), delta, {}, {}) == few) << "splats add exact zeros";
}

TEST(Glare, FewAndManySourcesFollowTheDefinition) {
    const Image<Vec3f> kernel = random_kernel(21, 9);
    bool splats = false, fft = false;
    for (const int lamps : {1, 3, 40, 3000}) {
        const Image<Vec3f> picture = night(83, 61, lamps, 11);
        GlareReport report;
        const Image<Vec3f> out = add_glare(picture.view(), kernel, {}, {}, &report);
        EXPECT_LT(largest_difference(out, oracle(picture, kernel, 1)), 2e-4) << lamps;
        (report.fft ? fft : splats) = true;
    }
    EXPECT_TRUE(splats);
    const Image<Vec3f> wide = random_kernel(101, 4), picture = night(120, 90, 6000, 2);
    GlareReport report;
    const Image<Vec3f> out = add_glare(picture.view(), wide, {}, {}, &report);
    EXPECT_LT(largest_difference(out, oracle(picture, wide, 1)), 1e-3);
    EXPECT_TRUE(report.fft || fft) << report.reason;
}

TEST(Glare, LightNearBordersIsLostByTheShareOutside) {
    Image<Vec3f> kernel(5, 5);
    for (Vec3f& p : kernel.pixels)
        p = {0.04f, 0.04f, 0.04f};
    Image<Vec3f> picture(9, 9);
    picture(0, 4) = {2, 2, 2};
    GlareReport report;
    const Image<Vec3f> out = add_glare(picture.view(), kernel, {}, {}, &report);
    EXPECT_NEAR(report.lost, 0.4, 1e-6);
    EXPECT_NEAR(report.spread, 0.96, 1e-6);
    EXPECT_EQ(out(3, 4), Vec3f{});
    EXPECT_EQ(out(8, 4), Vec3f{}) << "nothing wraps around";
    picture(0, 4) = {};
    picture(8, 8) = {2, 2, 2};
    add_glare(picture.view(), kernel, {}, {}, &report);
    EXPECT_NEAR(report.lost, 16.0 / 25, 1e-6);
}

TEST(Glare, IsLinearInTheSources) {
    const Image<Vec3f> kernel = random_kernel(31, 6);
    const Image<Vec3f> a = night(64, 64, 30, 1), b = night(64, 64, 30, 2);
    const auto bright = [](const Image<Vec3f>& from) {
        Image<Vec3f> only = from;
        for (Vec3f& p : only.pixels) {
            if (largest(p) <= 1) p = {};
        }
        return only;
    };
    const Image<Vec3f> first = bright(a), second = bright(b);
    Image<Vec3f> both = first;
    for (std::size_t i = 0; i < both.pixels.size(); ++i)
        both.pixels[i] = both.pixels[i] + second.pixels[i] * 3.0f;
    const Image<Vec3f> ga = add_glare(first.view(), kernel, {}, {}),
                       gb = add_glare(second.view(), kernel, {}, {}),
                       gab = add_glare(both.view(), kernel, {}, {});
    for (std::size_t i = 0; i < both.pixels.size(); ++i) {
        const Vec3f d = gab.pixels[i] - ga.pixels[i] - gb.pixels[i] * 3.0f;
        ASSERT_LT(largest(d), 2e-4f);
        ASSERT_GT(-largest(-d), -2e-4f);
    }
}

TEST(Glare, EveryPixelTakesTheKernelItChose) {
    const std::vector<Image<Vec3f>> kernels = {random_kernel(11, 1), random_kernel(5, 2),
                                               random_kernel(17, 3)};
    const Image<Vec3f> picture = night(48, 40, 60, 8);
    Image<std::uint16_t> choice(48, 40);
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 48; ++x)
            choice(x, y) = static_cast<std::uint16_t>((x / 7 + y / 5) % 3);
    }
    Image<Vec3f> out = picture;
    spread_glare(out.view(), {kernels, choice.view()}, {}, {});
    Image<Vec3d> expected(48, 40);
    for (std::size_t k = 0; k < kernels.size(); ++k) {
        Image<Vec3f> own = picture;
        for (std::size_t i = 0; i < own.pixels.size(); ++i) {
            if (largest(own.pixels[i]) > 1 ? choice.pixels[i] != k : k > 0) own.pixels[i] = {};
        }
        const Image<Vec3d> part = oracle(own, kernels[k], 1);
        for (std::size_t i = 0; i < part.pixels.size(); ++i)
            expected.pixels[i] = expected.pixels[i] + part.pixels[i];
    }
    EXPECT_LT(largest_difference(out, expected), 2e-4);
}

TEST(Glare, BloomApproachesTheFullResolution) {
    // A wide smooth halo: what low resolution is for.
    Image<Vec3f> halo(129, 129);
    for (int y = 0; y < 129; ++y) {
        for (int x = 0; x < 129; ++x) {
            const double d = (x - 64) * (x - 64) + (y - 64) * (y - 64);
            const auto v = static_cast<float>(1 / (30 + d));
            halo(x, y) = {v, v, v};
        }
    }
    halo = unit_kernel(halo);
    const Image<Vec3f> picture = night(150, 110, 25, 4);
    const Image<Vec3d> exact = oracle(picture, halo, 1);
    for (const int scale : {1, 2, 4, 8}) {
        const Image<Vec3f> out = add_glare(picture.view(), halo, {.clip = 1, .bloom_scale = scale}, {});
        const double error = largest_difference(out, exact);
        EXPECT_LT(error, scale == 1 ? 1e-4 : 0.03) << scale << ": of lamps up to 100";
        if (scale > 1) {
            EXPECT_GT(error, 1e-4) << scale << ": it is an approximation";
        }
    }
}

TEST(Glare, SplitKernelsKeepSumAndCentreOfGravity) {
    const Image<Vec3f> kernel = random_kernel(63, 13);
    Image<float> plane(63, 63);
    for (std::size_t i = 0; i < plane.pixels.size(); ++i)
        plane.pixels[i] = kernel.pixels[i].x;
    const SplitKernel split = split_kernel(plane.view(), 4);
    const auto moments = [](const Image<float>& image, double step) {
        Vec3d m;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const auto v = static_cast<double>(image(x, y));
                m = m + Vec3d{v, v * step * (x - image.width / 2), v * step * (y - image.height / 2)};
            }
        }
        return m;
    };
    const Vec3d whole = moments(plane, 1), core = moments(split.core, 1), rest = moments(split.outskirts, 4);
    EXPECT_NEAR(core.x + rest.x, whole.x, 1e-6);
    EXPECT_NEAR(core.y + rest.y, whole.y, 1e-5);
    EXPECT_NEAR(core.z + rest.z, whole.z, 1e-5);
}

TEST(Glare, BitsDoNotDependOnThreadsOrInstructionSets) {
    const Image<Vec3f> kernel = random_kernel(65, 3);
    for (const int lamps : {2, 4000}) {
        for (const int scale : {1, 4}) {
            const Image<Vec3f> picture = night(100, 80, lamps, 17);
            const GlareParams params{.clip = 1, .bloom_scale = scale};
            const Image<Vec3f> expected = add_glare(picture.view(), kernel, params, {Isa::ref, 1});
            for (const Isa isa : supported_isas()) {
                for (const int threads : {1, 2, 5})
                    EXPECT_TRUE(add_glare(picture.view(), kernel, params, {isa, threads}) == expected)
                        << isa_name(isa) << " " << threads;
            }
        }
    }
}

TEST(Glare, BothWaysOfTheConvolutionAgree) {
    Dice dice{5};
    Image<float> source(37, 29), kernel(19, 23);
    for (float& v : source.pixels)
        v = dice() < 0.2f ? dice() : 0.0f;
    for (float& v : kernel.pixels)
        v = dice();
    const Image<float> a = convolve_splats(source.view(), kernel.view(), {}),
                       b = convolve_fft(source.view(), kernel.view(), {});
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        ASSERT_NEAR(a.pixels[i], b.pixels[i], 1e-4f);
}

TEST(Glare, PixelsThatAreNotFiniteStay) {
    Image<Vec3f> picture(9, 9);
    const float infinite = std::numeric_limits<float>::infinity();
    picture(4, 4) = {infinite, 1, 1};
    picture(1, 1) = {4, 4, 4};
    const Image<Vec3f> out = add_glare(picture.view(), random_kernel(3, 1), {}, {});
    EXPECT_EQ(out(4, 4), picture(4, 4));
    EXPECT_EQ(out(8, 8), Vec3f{});
    EXPECT_GT(out(2, 2).x, 0);
}

TEST(Glare, UnitKernelsKeepEveryChannel) {
    Image<Vec3f> sodium(3, 3);
    sodium(1, 1) = {6, 2, 0};
    sodium(0, 1) = {2, 0, 0};
    const Image<Vec3f> unit = unit_kernel(sodium);
    Vec3f total;
    for (const Vec3f& p : unit.pixels)
        total = total + p;
    EXPECT_NEAR(total.x, 1, 1e-6);
    EXPECT_NEAR(total.y, 1, 1e-6);
    EXPECT_NEAR(total.z, 1, 1e-6);
    EXPECT_NEAR(unit(0, 1).x, 0.25f, 1e-6f);
    EXPECT_EQ(unit(0, 1).y, 0);
    EXPECT_NEAR(unit(0, 1).z, 0.2f, 1e-6f);
}

TEST(Glare, TheMostItMayTakeGrowsWithPictureAndKernel) {
    const GlareCost small = most_glare(64, 64, 33, {}), wide = most_glare(64, 64, 257, {}),
                    large = most_glare(512, 512, 33, {});
    EXPECT_GT(wide.bytes, small.bytes);
    EXPECT_GT(large.bytes, small.bytes);
    EXPECT_GT(large.ms, small.ms);
    EXPECT_GE(small.bytes, 64 * 64 * 12);
    EXPECT_LT(most_glare(512, 512, 513, {.clip = 1, .bloom_scale = 4}).bytes,
              most_glare(512, 512, 513, {}).bytes);
}

/// A sky that grows brighter through the clip level and far beyond, under kernels that keep from 84 to 98 %
/// in place.
TEST(Glare, ASmoothSkyShowsNoContour) {
    for (const double kept : {0.982, 0.942, 0.84}) {
        constexpr int side = 41, reach = side / 2;
        Image<Vec3f> kernel(side, side);
        double tails = 0;
        const auto tail = [](int dx, int dy) { return std::pow(dx * dx + dy * dy, -1.5); };
        for (int y = -reach; y <= reach; ++y) {
            for (int x = -reach; x <= reach; ++x)
                tails += x == 0 && y == 0 ? 0.0 : tail(x, y);
        }
        for (int y = -reach; y <= reach; ++y) {
            for (int x = -reach; x <= reach; ++x) {
                const auto v = static_cast<float>(x == 0 && y == 0 ? kept : (1 - kept) * tail(x, y) / tails);
                kernel(x + reach, y + reach) = {v, v, v};
            }
        }
        Image<Vec3f> sky(640, 96);
        for (int y = 0; y < sky.height; ++y) {
            for (int x = 0; x < sky.width; ++x) {
                const float v = 0.5f + 2.5f * static_cast<float>(x) / 640.0f;
                sky(x, y) = {v, 0.9f * v, 0.8f * v};
            }
        }
        const Image<Vec3f> glare = add_glare(std::as_const(sky).view(), kernel, GlareParams{}, Exec{});
        for (int x = 1; x < 600; ++x) {
            const auto at = [&](int column) { return static_cast<double>(glare(column, 48).x); };
            EXPECT_GT(at(x), at(x - 1)) << x;
            EXPECT_NEAR(at(x), 0.5 * (at(x - 1) + at(x + 1)), 1e-3 * at(x)) << x;
        }
    }
}

}  // namespace
}  // namespace obscura
