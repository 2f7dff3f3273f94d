// Shares of the sun's disc are the formula's above the ground's horizon, and the exact shadow without a disc.

#include "hierarchy/terrain/day_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "raster/heights/height_sweep.h"
#include "tests/terrain/drawn_days.h"

namespace obscura {
namespace {

/// A wall of 100 m, 40 columns to the east of column 0, on a plain.
HeightField wall() {
    HeightField f{Image<std::int32_t>(60, 7), 10, 10, Diagonal::falling};
    for (int y = 0; y < 7; ++y)
        f.height_q16(40, y) = height_q16_of(100);
    return f;
}

FarSun eastern_sun(const HeightField& f, double elevation_deg) {
    return {6, 1, 90, elevation_deg, height_sun(f, 90, elevation_deg)};
}

TEST(DayLight, BehindAWallIsTheFormula) {
    const HeightField f = wall();
    constexpr double radius = 0.265;
    int partly = 0;
    for (double elevation = 12; elevation < 18; elevation += 0.07) {
        const Image<float> shares = lit_shares(f, eastern_sun(f, elevation), radius, {});
        for (int x = 0; x < 40; ++x) {
            // atan and acos of this test are the C library's.
            const double horizon = std::atan(100.0 / (10.0 * (40 - x))) * 180 / 3.14159265358979323846;
            const double d = std::clamp((horizon - elevation) / radius, -1.0, 1.0);
            const double share = (std::acos(d) - d * std::sqrt(1 - d * d)) / 3.14159265358979323846;
            ASSERT_NEAR(shares(x, 3), share, 2e-5) << "column " << x << " at " << elevation;
            partly += share > 0.01 && share < 0.99;
        }
        // Beyond it nothing hides the sun.
        EXPECT_EQ(shares(50, 3), 1);
    }
    EXPECT_GT(partly, 50);
}

TEST(DayLight, ADiscIsHalfLitWhereItsMiddleTouchesTheHorizon) {
    const HeightField f = drawn::hills(90, 80);
    for (const FarSun& sun : drawn::suns_over(f, 7)) {
        const Image<float> hard = lit_shares(f, sun, 0, {}), soft = lit_shares(f, sun, 0.265, {});
        const int whole[] = {0};
        const ShadowBits dark = sweep_shadows(f, sun.direction, whole)[0];
        for (int y = 0; y < f.height(); ++y) {
            for (int x = 0; x < f.width(); ++x) {
                ASSERT_EQ(hard(x, y), dark(x, y) ? 0 : 1);
                if (std::fabs(soft(x, y) - 0.5f) > 0.001f) {
                    ASSERT_EQ(hard(x, y), soft(x, y) > 0.5f ? 1 : 0);
                }
            }
        }
    }
}

TEST(DayLight, HoursAreSumsOfSharesAndAPenumbraIsWorthItsShare) {
    const HeightField f = drawn::hills(70, 60);
    const std::vector<FarSun> suns = drawn::suns_over(f, 20);
    for (const double radius : {0.0, 0.265, 2.0}) {
        Image<float> sum(70, 60);
        for (const FarSun& sun : suns) {
            const Image<float> shares = lit_shares(f, sun, radius, {});
            for (std::size_t i = 0; i < sum.pixels.size(); ++i)
                sum.pixels[i] += static_cast<float>(sun.hours) * shares.pixels[i];
        }
        EXPECT_EQ(lit_hours(f, suns, radius, {}), sum) << radius;
        EXPECT_EQ(lit_hours(f, suns, radius, {Isa::ref, 3}), sum) << radius;
    }
}

TEST(DayLight, CurvedGroundHasTheFormulasDrop) {
    EXPECT_NEAR(earth_drop_m(1e10, 0), 784.8, 0.1);
    EXPECT_NEAR(earth_drop_m(1e10, 0.13), 682.8, 0.1);
    // A hill of 900 m, 100 km off to the east, under a sun at the angle at which its top stands without
    // curvature.
    HeightField f{Image<std::int32_t>(201, 3), 1000, 1000, Diagonal::falling};
    for (int y = 0; y < 3; ++y)
        f.height_q16(200, y) = height_q16_of(900);
    const double level = std::atan(900.0 / 1e5) * 180 / 3.14159265358979323846;
    const double with = std::atan((900.0 - earth_drop_m(1e10, 0.13)) / 1e5) * 180 / 3.14159265358979323846;
    const auto lit = [&](const HeightField& ground, double elevation) {
        return lit_shares(ground, eastern_sun(ground, elevation), 0, {})(100, 1) == 1;
    };
    EXPECT_FALSE(lit(f, level - 0.001));
    EXPECT_TRUE(lit(f, level + 0.001));
    const HeightField c = curved(f, 0.13);
    EXPECT_TRUE(lit(c, level - 0.001));
    EXPECT_FALSE(lit(c, with - 0.001));
    EXPECT_TRUE(lit(c, with + 0.001));
}

}  // namespace
}  // namespace obscura
