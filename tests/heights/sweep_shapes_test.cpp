// Ground whose shadows one can write down.

#include <gtest/gtest.h>

#include <cmath>

#include "core/num.h"
#include "raster/heights/height_march.h"
#include "raster/heights/height_sweep.h"

namespace obscura {
namespace {

constexpr int whole[] = {0};

template <class F>
HeightField field_of(int w, int h, double cell_x_m, double cell_y_m, F&& height_m) {
    HeightField f{Image<std::int32_t>(w, h), cell_x_m, cell_y_m, Diagonal::falling};
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x)
            f.height_q16(x, y) = height_q16_of(height_m(x, y));
    }
    return f;
}

std::int64_t dark_samples(const HeightField& f, const HeightSun& sun) {
    const ShadowBits swept = sweep_shadows(f, sun, whole)[0];
    EXPECT_EQ(swept, march_shadows(f, sun));
    return count_of(swept);
}

TEST(HeightShapes, LevelGroundIsLit) {
    const HeightField f = field_of(40, 30, 30, 20, [](int, int) { return 1234.5; });
    for (int azimuth = 0; azimuth < 360; azimuth += 7)
        EXPECT_EQ(dark_samples(f, height_sun(f, azimuth, 0.5)), 0) << azimuth;
}

TEST(HeightShapes, PlanesAreDarkWhereTheyFallAwayMoreSteeplyThanRays) {
    // Falling to the west by 8 m a cell of 8 m: 45 degrees.
    const HeightField f = field_of(30, 20, 8, 8, [](int x, int) { return 8.0 * x; });
    EXPECT_EQ(dark_samples(f, height_sun_towards(f, 1, 0, 0.99)), 29 * 20) << "but for the ridge";
    EXPECT_EQ(dark_samples(f, height_sun_towards(f, 1, 0, 1.01)), 0);
    EXPECT_EQ(dark_samples(f, height_sun_towards(f, -1, 0, 0.01)), 0) << "sun in the west";
    HeightSun grazing = height_sun_towards(f, 1, 0, 1);
    grazing.rise_q36 = std::int64_t{8} << rise_fraction_bits;
    EXPECT_EQ(dark_samples(f, grazing), 0) << "a ray in the surface is not below it";
    grazing.rise_q36 -= 1;
    EXPECT_EQ(dark_samples(f, grazing), 29 * 20) << "lower by 2^-36 m a cell";
    grazing.rise_q36 += 2;
    EXPECT_EQ(dark_samples(f, grazing), 0);
}

TEST(HeightShapes, GrazingPlanesInAnyDirection) {
    for (const std::int64_t slope : {std::int64_t{0}, cell_q20 / 3, cell_q20 / 2, cell_q20}) {
        const HeightField f = field_of(17, 23, 1, 1, [](int x, int y) { return 3.0 * x - 2.0 * y; });
        HeightSun sun = height_sun_towards(f, 1, 0.1, 1);
        sun.slope_q20 = slope;
        // Exactly as the plane rises towards the sun: 3 m a column, and 2 m a row northwards.
        sun.rise_q36 = (std::int64_t{3} << rise_fraction_bits) + (slope << (rise_fraction_bits - 20 + 1));
        EXPECT_EQ(dark_samples(f, sun), 0) << slope;
        sun.rise_q36 -= 1;
        EXPECT_GT(dark_samples(f, sun), 16 * 23 / 2) << slope;
    }
}

TEST(HeightShapes, SpikesAndWalls) {
    const HeightField spike =
        field_of(30, 21, 1, 1, [](int x, int y) { return x == 20 && y == 10 ? 7.5 : 0.0; });
    EXPECT_EQ(dark_samples(spike, height_sun_towards(spike, 1, 0, 1)), 7) << "7.5 m at 45 degrees: 7 samples";
    EXPECT_EQ(dark_samples(spike, height_sun_towards(spike, 1, -1, 1)), 5)
        << "along the diagonals, sqrt 2 m apart";
    EXPECT_EQ(dark_samples(spike, height_sun_towards(spike, 1, 1, 1)), 5 + 2 * 3)
        << "ridges of 3.75 m on either side";
    const HeightField wall = field_of(30, 21, 1, 1, [](int x, int) { return x == 20 ? 7.5 : 0.0; });
    EXPECT_EQ(dark_samples(wall, height_sun_towards(wall, 1, 0, 1)), 7 * 21);
}

/// A roof whose ridge runs from north to south: whatever the azimuth, a sample at x cells from it is dark
/// where the ridge stands above its ray, and rays reach the ridge on the grid unless they begin too far
/// north.
TEST(HeightShapes, RoofsInAnyDirection) {
    const double ridge_m = 80, fall_m = 16;
    const auto roof = [&](int x) { return std::max(0.0, ridge_m - fall_m * std::abs(x - 40)); };
    const HeightField f = field_of(64, 96, 8, 4, [&](int x, int) { return roof(x); });
    for (const double north : {0.0, 0.1, 0.35, 0.5}) {
        const HeightSun sun = height_sun_towards(f, 1, north, 0.5);
        ASSERT_TRUE(sun.lines_are_columns);
        const ShadowBits map = sweep_shadows(f, sun, whole)[0];
        EXPECT_EQ(map, march_shadows(f, sun));
        const double rise_m = std::ldexp(static_cast<double>(sun.rise_q36), -rise_fraction_bits);
        int dark = 0;
        for (int y = 45; y < 96; ++y) {
            for (int x = 0; x < 64; ++x) {
                const bool hidden = x < 40 && ridge_m - roof(x) > rise_m * (40 - x);
                ASSERT_EQ(map(x, y), hidden) << x << " " << y << " north " << north;
                dark += hidden;
            }
        }
        EXPECT_GT(dark, 51 * 10);
    }
}

TEST(HeightShapes, ExtremesOfHeightAndSize) {
    // A cell in a million of 9000 m, and one sample.
    const HeightField tower =
        field_of(1000, 1000, 30, 30, [](int x, int y) { return x == 500 && y == 500 ? 9000.0 : 0.0; });
    const HeightSun low = height_sun_towards(tower, 0.3, -1, num::sin_deg(0.5) / num::cos_deg(0.5));
    EXPECT_GT(count_of(sweep_shadows(tower, low, whole)[0]), 300);
    const HeightField one = field_of(1, 1, 1, 1, [](int, int) { return -400.0; });
    EXPECT_EQ(dark_samples(one, height_sun(one, 33, 1)), 0);
    EXPECT_EQ(dark_samples(one, height_sun(one, 33, 90)), 0);
    // Summit and trench, the sun at the zenith and on the horizon.
    const HeightField deep =
        field_of(9, 9, 1e-3, 1e-3, [](int x, int y) { return (x + y) % 2 == 0 ? 32767.0 : -32767.0; });
    EXPECT_EQ(dark_samples(deep, height_sun(deep, 90, 90)), 0);
    EXPECT_EQ(dark_samples(deep, height_sun(deep, 90, 1e-9)), 4 * 4 + 4 * 5)
        << "all trenches but those of the border";
}

TEST(HeightShapes, RoundEarthHidesWhatIsFar) {
    // A tower of 100 m on the level sea: seen from the water up to sqrt(2 R h) = 35.7 km away, or 38.3 with
    // refraction.
    const HeightField sea = field_of(1201, 3, 100, 100, [](int x, int) { return x == 1100 ? 100.0 : 0.0; });
    const auto dark = [](const HeightField& f) {
        int n = 0;
        HeightSun level = height_sun_towards(f, 1, 0, 1e-7);
        const ShadowBits map = sweep_shadows(f, level, whole)[0];
        for (int x = 0; x < 1100; ++x)
            n += map(x, 1) ? 1 : 0;
        return n;
    };
    EXPECT_EQ(dark(sea), 1100) << "as far as one likes over a plane";
    const HeightField round = curved(sea, 0), bent = curved(sea, 0.13);
    EXPECT_NEAR(metres_of(round.height_q16(0, 1)), -60'000.0 * 60'000.0 / (2 * 6'371'000.0), 0.001);
    EXPECT_EQ(round.height_q16(600, 1), 0) << "the middle stays";
    // The sun at 0 degrees above the middle's level stands lower or higher elsewhere, so look for lit water
    // in between.
    EXPECT_LT(dark(round), 1100);
    EXPECT_GT(dark(bent), dark(round)) << "refraction lifts what is far";
}

}  // namespace
}  // namespace obscura
