// The sweep gives every bit of the march, the march that of the surface.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "raster/heights/height_horizon.h"
#include "raster/heights/height_march.h"
#include "raster/heights/height_near.h"
#include "raster/heights/height_sweep.h"
#include "tests/heights/drawn_heights.h"

namespace obscura {
namespace {

constexpr int thresholds[] = {0, 1, 2, 6};

TEST(HeightSweep, EqualsTheMarchOnDrawnGrids) {
    std::int64_t dark = 0;
    SweepStats stats;
    for (std::uint64_t seed = 0; seed < 6000; ++seed) {
        drawn::Random random(seed);
        const HeightField field = drawn::heights(random);
        const HeightSun sun = drawn::sun(random, field);
        const auto maps = sweep_shadows(field, sun, thresholds, &stats);
        for (std::size_t i = 0; i < std::size(thresholds); ++i) {
            ASSERT_EQ(maps[i], march_shadows(field, sun, {.first = thresholds[i]}))
                << "seed " << seed << ", threshold " << thresholds[i];
            dark += count_of(maps[i]);
        }
    }
    // Neither side is empty, and ties came about.
    EXPECT_GT(dark, stats.samples / 50);
    EXPECT_LT(dark, stats.samples / 2);
    EXPECT_GT(stats.marched, 1000);
    EXPECT_LT(stats.marched, stats.samples / 10);
}

TEST(HeightSweep, NearOrFarIsTheWholeShadow) {
    for (std::uint64_t seed = 0; seed < 1500; ++seed) {
        drawn::Random random(seed);
        const HeightField field = drawn::heights(random);
        const HeightSun sun = drawn::sun(random, field);
        const auto maps = sweep_shadows(field, sun, thresholds);
        for (std::size_t i = 1; i < std::size(thresholds); ++i) {
            const ShadowBits near_bits = march_shadows(field, sun, {.first = 0, .last = thresholds[i]});
            ASSERT_EQ(united(near_bits, maps[i]), maps[0])
                << "seed " << seed << ", threshold " << thresholds[i];
        }
        const ShadowBits between = march_shadows(field, sun, {.first = 1, .last = 6});
        ASSERT_EQ(united(between, maps[3]), maps[1]) << "seed " << seed;
    }
}

TEST(HeightNear, EqualsTheMarchOnDrawnGrids) {
    std::int64_t hidden = 0;
    for (std::uint64_t seed = 0; seed < 4000; ++seed) {
        drawn::Random random(seed);
        const HeightField field = drawn::heights(random);
        const HeightSun sun = drawn::sun(random, field);
        ShadowBits all(field.width(), field.height()), some = all;
        for (int y = 0; y < field.height(); ++y) {
            for (int x = 0; x < field.width(); ++x) {
                all.set(x, y);
                if (drawn::below(random, 3) == 0) some.set(x, y);
            }
        }
        for (const int last : {0, 1, 2, 6, 1000}) {
            ShadowBits marched = march_shadows(field, sun, {.first = 0, .last = last});
            ASSERT_EQ(near_shadows(field, sun, last, all), marched) << "seed " << seed << ", last " << last;
            hidden += count_of(marched);
            for (std::size_t i = 0; i < some.words.size(); ++i)
                marched.words[i] &= some.words[i];
            ASSERT_EQ(near_shadows(field, sun, last, some), marched) << "seed " << seed;
        }
    }
    EXPECT_GT(hidden, 100'000);
}

TEST(HeightSweep, TurnedAndMirroredGroundHasTurnedAndMirroredShadows) {
    for (std::uint64_t seed = 0; seed < 1500; ++seed) {
        drawn::Random random(seed);
        const HeightField field = drawn::heights(random);
        const HeightSun sun = drawn::sun(random, field);
        const auto maps = sweep_shadows(field, sun, thresholds);
        const auto turned_maps = sweep_shadows(turned(field), drawn::turned(sun), thresholds);
        const auto mirrored_maps = sweep_shadows(mirrored(field), drawn::mirrored(sun), thresholds);
        const int w = field.width(), h = field.height();
        for (std::size_t i = 0; i < std::size(thresholds); ++i) {
            for (int y = 0; y < h; ++y) {
                for (int x = 0; x < w; ++x) {
                    ASSERT_EQ(turned_maps[i](h - 1 - y, x), maps[i](x, y)) << "seed " << seed;
                    ASSERT_EQ(mirrored_maps[i](w - 1 - x, y), maps[i](x, y)) << "seed " << seed;
                }
            }
        }
    }
}

TEST(HeightSweep, AzimuthsAreClockwiseFromNorth) {
    HeightField field{Image<std::int32_t>(9, 7), 2.0, 3.0, Diagonal::falling};
    field.height_q16(4, 3) = height_q16_of(5.0);
    const struct {
        double azimuth_deg;
        int x, y;  // where the spike's shadow falls, from it
    } cases[] = {{0, 0, 1}, {90, -1, 0}, {180, 0, -1}, {270, 1, 0}};
    for (const auto& c : cases) {
        const int whole[] = {0};
        const ShadowBits map = sweep_shadows(field, height_sun(field, c.azimuth_deg, 45), whole)[0];
        EXPECT_TRUE(map(4 + c.x, 3 + c.y)) << c.azimuth_deg;
        EXPECT_TRUE(map(4 + 2 * c.x, 3 + 2 * c.y) == (c.x != 0))
            << "cells of 2 and 3 m, 5 m high " << c.azimuth_deg;
        EXPECT_EQ(count_of(map), c.x != 0 ? 2 : 1);
    }
}

/// Height of the surface at a point of the grid, by its triangles and without any view.
double surface_m(const HeightField& f, double x, double y) {
    const int i = std::min(static_cast<int>(x), f.width() - 2),
              j = std::min(static_cast<int>(y), f.height() - 2);
    const double a = x - i, b = y - j;
    const auto m = [&](int dx, int dy) { return metres_of(f.height_q16(i + dx, j + dy)); };
    if (f.diagonal == Diagonal::falling) {
        return a >= b ? m(0, 0) + a * (m(1, 0) - m(0, 0)) + b * (m(1, 1) - m(1, 0))
                      : m(0, 0) + b * (m(0, 1) - m(0, 0)) + a * (m(1, 1) - m(0, 1));
    }
    return a + b <= 1 ? m(0, 0) + a * (m(1, 0) - m(0, 0)) + b * (m(0, 1) - m(0, 0))
                      : m(1, 1) + (1 - a) * (m(0, 1) - m(1, 1)) + (1 - b) * (m(1, 0) - m(1, 1));
}

/// Where a ray from a sample, t times (dx, dy) later, passes over edges of triangles: between these the
/// surface above it is linear.
std::vector<double> edges_along(const HeightField& f, double dx, double dy) {
    std::vector<double> times;
    const int reach = f.width() + f.height();
    const double rates[] = {dx, dy, f.diagonal == Diagonal::falling ? dx - dy : dx + dy};
    for (const double rate : rates) {
        for (int k = 1; std::fabs(rate) > 1e-12 && k <= reach; ++k)
            times.push_back(k / std::fabs(rate));
    }
    return times;
}

TEST(HeightMarch, IsTheSurfaceAboveTheRay) {
    std::int64_t hidden = 0, free = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        drawn::Random random(seed);
        const HeightField field = drawn::heights(random, 12);
        if (field.width() < 2 || field.height() < 2) continue;
        const HeightSun sun = drawn::sun(random, field);
        const ShadowBits map = march_shadows(field, sun);
        const double slope = static_cast<double>(sun.slope_q20) / static_cast<double>(cell_q20);
        const double rise_m = std::ldexp(static_cast<double>(sun.rise_q36), -rise_fraction_bits);
        const double dx = sun.lines_are_columns ? sun.step_line : slope * sun.step_along;
        const double dy = sun.lines_are_columns ? slope * sun.step_along : sun.step_line;
        for (int y = 0; y < field.height(); ++y) {
            for (int x = 0; x < field.width(); ++x) {
                // The greatest height above the ray stands over an edge.
                double above = -1e9;
                for (const double t : edges_along(field, dx, dy)) {
                    const double u = x + t * dx, v = y + t * dy;
                    const double right = field.width() - 1, bottom = field.height() - 1;
                    if (std::min(u, v) < -1e-9 || u > right + 1e-9 || v > bottom + 1e-9) continue;
                    const double ground_m =
                        surface_m(field, std::clamp(u, 0.0, right), std::clamp(v, 0.0, bottom));
                    above = std::max(above, ground_m - metres_of(field.height_q16(x, y)) - t * rise_m);
                }
                if (std::fabs(above) < 1e-5) continue;
                EXPECT_EQ(map(x, y), above > 0)
                    << "seed " << seed << " at " << x << ", " << y << " by " << above;
                ++(above > 0 ? hidden : free);
            }
        }
    }
    EXPECT_GT(hidden, 2000);
    EXPECT_GT(free, 2000);
}

TEST(HeightHorizon, SunsAboveItAreSeenAndSunsBelowAreNot) {
    std::int64_t above = 0, below = 0;
    for (std::uint64_t seed = 0; seed < 600; ++seed) {
        drawn::Random random(seed);
        const HeightField field = drawn::heights(random, 14);
        HeightSun sun = drawn::sun(random, field);
        const Image<float> horizon = horizon_tangents(field, sun, {best_isa(), 1});
        const double slope = static_cast<double>(sun.slope_q20) / static_cast<double>(cell_q20);
        const double across = sun.lines_are_columns ? field.cell_x_m : field.cell_y_m;
        const double along = slope * (sun.lines_are_columns ? field.cell_y_m : field.cell_x_m);
        const double tangent = std::ldexp(static_cast<double>(sun.rise_q36), -rise_fraction_bits) /
                               std::sqrt(across * across + along * along);
        const ShadowBits map = march_shadows(field, sun);
        for (int y = 0; y < field.height(); ++y) {
            for (int x = 0; x < field.width(); ++x) {
                const double h = horizon(x, y);
                if (h > tangent * (1 + 1e-6)) {
                    EXPECT_TRUE(map(x, y)) << "seed " << seed;
                    ++below;
                }
                if (h < tangent * (1 - 1e-6)) {
                    EXPECT_FALSE(map(x, y)) << "seed " << seed;
                    ++above;
                }
            }
        }
    }
    EXPECT_GT(above, 10'000);
    EXPECT_GT(below, 3'000);
}

TEST(HeightHorizon, DiscsAreLitByTheirPartAboveIt) {
    EXPECT_EQ(lit_share_of_disc(10, 9, 0.2665), 1);
    EXPECT_EQ(lit_share_of_disc(10, 11, 0.2665), 0);
    EXPECT_NEAR(lit_share_of_disc(10, 10, 0.2665), 0.5, 1e-12);
    EXPECT_NEAR(lit_share_of_disc(10, 9.8, 0.2665) + lit_share_of_disc(10, 10.2, 0.2665), 1, 1e-12);
    // By summing strips.
    double sum = 0;
    constexpr int strips = 100'000;
    for (int i = 0; i < strips; ++i) {
        const double y = -1 + 2 * (i + 0.5) / strips;
        if (y > 0.4) sum += 2 * std::sqrt(1 - y * y) * 2 / strips;
    }
    EXPECT_NEAR(lit_share_of_disc(0, 0.4, 1), sum / 3.14159265358979, 1e-6);
    EXPECT_EQ(lit_share_of_disc(5, -std::numeric_limits<double>::infinity(), 1), 1);
}

}  // namespace
}  // namespace obscura
