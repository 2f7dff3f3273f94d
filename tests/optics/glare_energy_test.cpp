// Where the light of glare goes: into the picture, out of it, or nowhere; and what is no light.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/optics/glare_pictures.h"

namespace obscura {
namespace {

TEST(Glare, EnergyStaysOrIsCountedAsLost) {
    for (const int scale : {1, 2, 4, 8}) {
        for (const int lamps : {1, 30, 2000}) {
            // Kernels wider than the picture: most light leaves it.
            for (const int side : {9, 45, 151}) {
                const Image<Vec3f> picture = night(70, 50, lamps, 21);
                GlareReport report;
                const Image<Vec3f> out = add_glare(picture.view(), random_kernel(side, 2),
                                                   {.clip = 1, .bloom_scale = scale}, {}, &report);
                const double sources = bright_sum(picture, 1);
                EXPECT_NEAR(sum(out) + report.lost * sources, sum(picture), 1e-4 * sources)
                    << scale << " " << lamps << " " << side;
                EXPECT_GT(report.lost, -1e-6);
                EXPECT_LT(report.lost, 1);
            }
        }
    }
}

TEST(Glare, NegativeChannelsStayAndCount) {
    // Darker than nothing all around, and in the sources: their sum of light may be below 0.
    for (const int lamps : {1, 2000}) {
        for (const int scale : {1, 4}) {
            Image<Vec3f> picture = night(60, 50, lamps, 3);
            for (Vec3f& p : picture.pixels)
                p = largest(p) > 1 ? Vec3f{p.x, 2 + p.y, -200} : p - Vec3f{0.7f, 0.7f, 0.7f};
            const double light = [&] {
                Image<Vec3f> positive = picture;
                for (Vec3f& p : positive.pixels)
                    p = {p.x, p.y, std::max(p.z, 0.0f)};
                return bright_sum(positive, 1);
            }();
            GlareReport report;
            const Image<Vec3f> out = add_glare(picture.view(), random_kernel(21, 2),
                                               {.clip = 1, .bloom_scale = scale}, {}, &report);
            EXPECT_NEAR(sum(out) + report.lost * light, sum(picture), 1e-4 * light) << lamps << " " << scale;
            EXPECT_GE(report.spread, 0);
            EXPECT_LE(report.spread, 1);
            EXPECT_LT(report.lost, 1);
        }
    }
}

TEST(Glare, TheLargestNumbersStayNumbers) {
    constexpr float most = std::numeric_limits<float>::max();
    for (const int scale : {1, 4}) {
        for (const bool all : {false, true}) {
            Image<Vec3f> picture(64, 64);
            for (Vec3f& p : picture.pixels)
                p = all ? Vec3f{most, most / 3, 0} : Vec3f{};
            picture(30, 30) = {most, most / 3, 0};
            GlareReport report;
            const Image<Vec3f> out = add_glare(picture.view(), random_kernel(33, 4),
                                               {.clip = 1, .bloom_scale = scale}, {}, &report);
            if (all && scale == 1) {
                EXPECT_TRUE(report.fft);
            }
            for (const Vec3f& p : out.pixels)
                ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && p.x >= 0 && p.z == 0);
            const double light = sum(picture);
            EXPECT_NEAR((sum(out) / light + report.lost), 1, 1e-4) << scale << all;
        }
    }
}

TEST(Glare, KernelsBelowOneBlockTheRest) {
    Image<Vec3f> kernel = random_kernel(15, 8);
    for (Vec3f& p : kernel.pixels)
        p = p * 0.25f;
    const Image<Vec3f> picture = night(70, 50, 30, 21);
    GlareReport report, whole;
    const Image<Vec3f> out = add_glare(picture.view(), kernel, {}, {}, &report);
    add_glare(picture.view(), random_kernel(15, 8), {}, {}, &whole);
    const double light = bright_sum(picture, 1);
    EXPECT_NEAR(report.blocked, 0.75, 1e-5);
    EXPECT_EQ(whole.blocked, 0);
    EXPECT_NEAR(report.spread, 0.25 * whole.spread, 1e-5);
    EXPECT_NEAR(sum(out) + (report.lost + report.blocked) * light, sum(picture), 1e-4 * light);
}

}  // namespace
}  // namespace obscura
