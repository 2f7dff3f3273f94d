// Rays from anywhere are those of the march at samples, and meet the surface that is there elsewhere.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "raster/heights/height_march.h"
#include "raster/heights/height_rays.h"
#include "tests/heights/drawn_heights.h"

namespace obscura {
namespace {

/// A cell and the place in it that a sample is, by one of the cells around it.
GroundPlace at_sample(const HeightField& f, int x, int y, int which) {
    const int cx = std::clamp(x - which % 2, 0, f.width() - 2),
              cy = std::clamp(y - which / 2, 0, f.height() - 2);
    return {cx, cy, double(x - cx), double(y - cy)};
}

/// Ground and a sun as drawn from a seed; rays where the ground has cells.
struct DrawnRays {
    drawn::Random random;
    HeightField f = drawn::heights(random);
    HeightSun sun = drawn::sun(random, f);
    HeightPyramid pyramid;
    std::optional<HeightRays> rays;

    explicit DrawnRays(std::uint64_t seed) : random(seed) {
        if (f.width() < 2 || f.height() < 2) return;
        pyramid = height_pyramid(f);
        rays.emplace(f, pyramid, sun);
    }
    DrawnRays(const DrawnRays&) = delete;
    DrawnRays& operator=(const DrawnRays&) = delete;
};

TEST(HeightRays, AreTheMarchAtSamples) {
    std::int64_t dark = 0, asked = 0;
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
        DrawnRays draw(seed);
        if (!draw.rays) continue;
        const HeightField& f = draw.f;
        for (const int last : {1, 3, 1000}) {
            const ShadowBits march = march_shadows(f, draw.sun, {.first = 0, .last = last});
            for (int y = 0; y < f.height(); ++y) {
                for (int x = 0; x < f.width(); ++x) {
                    const GroundPlace place = at_sample(f, x, y, drawn::below(draw.random, 4));
                    ASSERT_EQ(draw.rays->ground_hidden(place, last), march(x, y))
                        << "seed " << seed << ", " << last << " lines, sample " << x << ", " << y;
                    dark += march(x, y);
                    ++asked;
                }
            }
        }
    }
    EXPECT_GT(dark, asked / 50);
    EXPECT_LT(dark, asked / 2);
}

/// How far the surface stands above a ray at most, looked at in small steps; -infinity beside the grid.
double highest_above(const HeightField& f, const HeightSun& sun, HeightPoint p, double step) {
    const double slope = double(sun.slope_q20) / double(cell_q20),
                 rise = std::ldexp(double(sun.rise_q36), -rise_fraction_bits);
    double highest = -1e300;
    for (double t = step; t < 200; t += step) {
        const double across = sun.step_line * t, along = sun.step_along * slope * t;
        const double x = p.x + (sun.lines_are_columns ? across : along),
                     y = p.y + (sun.lines_are_columns ? along : across);
        if (x < 0 || y < 0 || x > f.width() - 1 || y > f.height() - 1) continue;
        const int cx = std::min(int(x), f.width() - 2), cy = std::min(int(y), f.height() - 2);
        highest = std::max(highest, ground_height_m(f, {cx, cy, x - cx, y - cy}) - (p.height_m + rise * t));
    }
    return highest;
}

double steepest(const HeightField& f, const HeightSun& sun) {
    double most = std::ldexp(double(sun.rise_q36), -rise_fraction_bits);
    for (int y = 0; y + 1 < f.height(); ++y) {
        for (int x = 0; x + 1 < f.width(); ++x) {
            const auto rise = [&](int x1, int y1) {
                return std::fabs(metres_of(f.height_q16(x1, y1)) - metres_of(f.height_q16(x, y)));
            };
            most = std::max({most, 4 * rise(x + 1, y), 4 * rise(x, y + 1), 4 * rise(x + 1, y + 1)});
        }
    }
    return most;
}

TEST(HeightRays, MeetTheSurfaceFromBetweenSamplesFromTheAirAndFromBeside) {
    std::int64_t hidden = 0, asked = 0;
    for (std::uint64_t seed = 0; seed < 600; ++seed) {
        DrawnRays draw(seed);
        if (!draw.rays) continue;
        auto& [random, f, sun, pyramid, rays] = draw;
        const double step = 0.003, slack = steepest(f, sun) * step * 2;
        for (int i = 0; i < 12; ++i) {
            const GroundPlace place{drawn::below(random, f.width() - 1), drawn::below(random, f.height() - 1),
                                    drawn::unit(random), drawn::unit(random)};
            HeightPoint p{place.cell_x + place.right, place.cell_y + place.down, ground_height_m(f, place)};
            bool answer = false;
            if (i % 3 == 0) {
                answer = rays->ground_hidden(place, 1 << 20);
            } else {
                if (i % 3 == 1) p.height_m += 2 * drawn::unit(random);
                if (i % 3 == 2) {
                    p.x += (drawn::unit(random) - 0.5) * 3 * f.width();
                    p.y += (drawn::unit(random) - 0.5) * 3 * f.height();
                    p.height_m += 3;
                }
                answer = rays->hidden(p);
            }
            const double above = highest_above(f, sun, p, step);
            ++asked;
            hidden += answer;
            // In the air of a place beside the grid a point may be below the ground there.
            const bool inside = p.x >= 0 && p.y >= 0 && p.x <= f.width() - 1 && p.y <= f.height() - 1;
            // And one at the border leaves the grid within a step.
            if ((i % 3 == 2 && inside) || (answer && above == -1e300)) continue;
            if (answer) {
                EXPECT_GT(above, -slack) << "seed " << seed << ", point " << i;
            } else {
                EXPECT_LT(above, 1e-6) << "seed " << seed << ", point " << i;
            }
        }
    }
    EXPECT_GT(hidden, asked / 20);
    EXPECT_LT(hidden, asked * 2 / 3);
}

TEST(HeightRays, PassOverLowGroundInBlocks) {
    HeightField f{Image<std::int32_t>(1025, 1025), 10, 10, Diagonal::falling};
    for (int y = 0; y < 1025; ++y) {
        for (int x = 0; x < 1025; ++x)
            f.height_q16(x, y) = height_q16_of(x == 1000 ? 4000 : (x * 7 + y * 13) % 5);
    }
    const HeightPyramid pyramid = height_pyramid(f);
    EXPECT_EQ(pyramid.top(), 4);
    EXPECT_EQ(pyramid.greatest_q16(4, 3, 1023), height_q16_of(4000));
    const HeightRays rays(f, pyramid, height_sun(f, 80, 20));
    HeightRayCounts counts;
    // 1000 columns of ground far below the ray lie between the hill's foot and the wall.
    EXPECT_TRUE(rays.hidden({2, 500, 40}, &counts));
    EXPECT_LT(counts.cells + counts.blocks, 100);
    // Behind the wall there is none.
    EXPECT_FALSE(rays.hidden({1001.5, 500, 5}));
}

}  // namespace
}  // namespace obscura
