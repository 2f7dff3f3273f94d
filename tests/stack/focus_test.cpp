// Views of a stack: where samples stand, and what all views keep.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "raster/view.h"
#include "tests/stack/stack_scenes.h"

namespace obscura {
namespace {

using lit::Lamp;
constexpr Lamp lamps[] = {Lamp::level, Lamp::tilted, Lamp::sun, Lamp::path};

TEST(LightSamples, FollowAHilbertCurve) {
    for (const int count : {1, 2, 4, 8, 16, 64, 512, 1024}) {
        const std::vector<Vec2d> samples = hilbert_samples(count);
        ASSERT_EQ(samples.size(), static_cast<std::size_t>(count));
        std::set<std::pair<double, double>> cells;
        double least_x = 2, least_y = 2;
        for (const Vec2d& s : samples) {
            EXPECT_TRUE(s.x > 0 && s.x < 1 && s.y > 0 && s.y < 1);
            cells.emplace(s.x, s.y);
            least_x = std::min(least_x, s.x);
            least_y = std::min(least_y, s.y);
        }
        EXPECT_EQ(cells.size(), samples.size()) << "every cell once";
        // Steps go to neighbours: by one cell along one axis.
        for (std::size_t i = 1; i < samples.size(); ++i) {
            const double dx = std::fabs(samples[i].x - samples[i - 1].x) / (2 * least_x),
                         dy = std::fabs(samples[i].y - samples[i - 1].y) / (2 * least_y);
            EXPECT_NEAR(dx + dy, 1, 1e-9) << count << ", " << i;
        }
        // Aligned runs of 4^j are squares.
        for (std::size_t run = 4; run <= samples.size(); run *= 4) {
            double low = 2, high = -1;
            for (std::size_t i = 0; i < run; ++i) {
                low = std::min(low, samples[i].y);
                high = std::max(high, samples[i].y);
            }
            EXPECT_NEAR((high - low) / (2 * least_y) + 1, std::sqrt(static_cast<double>(run)), 1e-9);
        }
    }
}

/// Samples that came in another order are put in that of a curve: steps from cell to neighbouring cell.
TEST(LightSamples, ArePutInAHilbertCurvesOrder) {
    for (const int side : {2, 4, 8, 32}) {
        std::vector<Vec2d> places;
        for (int i = 0; i < side * side; ++i)
            places.push_back({3 + 0.5 * (i % side), -7 + 0.5 * (i / side)});
        const std::vector<std::size_t> order = hilbert_order(places);
        ASSERT_EQ(std::set<std::size_t>(order.begin(), order.end()).size(), places.size());
        for (std::size_t k = 1; k < order.size(); ++k) {
            const Vec2d a = places[order[k - 1]], b = places[order[k]];
            EXPECT_NEAR(std::fabs(a.x - b.x) + std::fabs(a.y - b.y), 0.5, 1e-12) << side << ", " << k;
        }
    }
    EXPECT_EQ(hilbert_order({{1, 1}, {1, 1}, {1, 1}}), (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_TRUE(hilbert_order({}).empty());
}

TEST(LightSamples, ADiscHasEqualAreas) {
    const LightSamples disc = disc_samples({1, 2, 3}, {1, 1, 0}, 2, 1024);
    double inner = 0;
    Vec3d middle{0, 0, 0};
    for (const Vec3d& p : disc.at) {
        const Vec3d d = p - Vec3d{1, 2, 3};
        EXPECT_NEAR(dot(d, Vec3d{1, 1, 0}), 0, 1e-12);
        EXPECT_LT(dot(d, d), 4);
        inner += dot(d, d) < 1 ? 1 : 0;
        middle = middle + d * (1.0 / 1024);
    }
    EXPECT_NEAR(inner / 1024, 0.25, 0.01);
    EXPECT_NEAR(dot(middle, middle), 0, 1e-20);
    for (const Vec3d& d : sun_samples({0, -1, 0}, 0.265, 64).at) {
        EXPECT_NEAR(dot(d, d), 1, 1e-12);
        EXPECT_GE(-d.y, std::cos(0.265 * 3.14159265358979 / 180) - 1e-12);
    }
}

/// A straight line from the light through a point meets the plane at the texel that every map shows the point
/// at.
TEST(FocusedViews, ThePlaneKeepsItsTexels) {
    const Mesh mesh = lit::scene(3, false);
    for (const Lamp lamp : lamps) {
        const LightSamples samples = lit::samples_of(lamp, 16);
        FocusParams params = lit::focus(512);
        params.plane_point = {0, 0.5, 0};
        params.plane_normal = lamp == Lamp::path ? Vec3d{0, 1, 0} : Vec3d{0.1, 2, -0.2};
        ASSERT_TRUE(can_focus(samples, params));
        const FocusedViews views = focused_views(mesh, samples, params);
        const Vec3d n = normalize(params.plane_normal);
        std::mt19937 rng(7);
        const auto uniform = [&] { return static_cast<double>(rng()) / 4294967296.0 * 16 - 8; };
        for (int i = 0; i < 200; ++i) {
            const Vec3d p{uniform(), uniform() * 0.2 + 2, uniform()};
            for (int k = 0; k < 16; ++k) {
                const Vec3d sample = samples.at[static_cast<std::size_t>(k)];
                const Vec3d way = samples.directional ? sample : p - sample;
                const Vec3d on_plane = p - way * (dot(n, p - params.plane_point) / dot(n, way));
                const Vec3d at = to_map_space(views.view(k), p),
                            below = to_map_space(views.view(0), on_plane);
                EXPECT_NEAR(at.x, below.x, 2e-2) << static_cast<int>(lamp) << " map " << k;
                EXPECT_NEAR(at.y, below.y, 2e-2);
                const Vec3d again = to_map_space(views.view(k), on_plane);
                EXPECT_NEAR(again.x, below.x, 1e-6);
                EXPECT_NEAR(again.z, below.z, 1e-9);
            }
        }
    }
}

TEST(FocusedViews, HoldAllCasters) {
    for (const std::uint32_t seed : {1u, 2u}) {
        const Mesh mesh = lit::scene(seed, true);
        for (const Lamp lamp : lamps) {
            const FocusedViews views = focused_views(mesh, lit::samples_of(lamp, 16), lit::focus(256));
            for (int k = 0; k < 16; ++k) {
                const LightView view = views.view(k);
                for (const Vec3f& v : mesh.positions) {
                    const Vec3d p = to_map_space(view, to_double(v));
                    EXPECT_TRUE(p.x >= 0.9 && p.x <= 255.1 && p.y >= 0.9 && p.y <= 255.1)
                        << p.x << ' ' << p.y << " lamp " << static_cast<int>(lamp);
                    EXPECT_TRUE(p.z > 0 && p.z < 1);
                    if (view.perspective) {
                        const Vec4d h =
                            view.to_map * Vec4d{to_double(v).x, to_double(v).y, to_double(v).z, 1};
                        EXPECT_GT(h.w, view.near_w) << "nothing is clipped";
                    }
                }
            }
        }
    }
}

/// A lamp below what casts: one near plane for all maps, in the world.
TEST(FocusedViews, OneNearPlane) {
    Mesh mesh = lit::scene(4, false);
    solids::add(mesh, solids::shifted(box({6, 16, 6}), {0, 16, 0}));
    const LightSamples samples = lit::samples_of(Lamp::tilted, 16);
    const FocusedViews views = focused_views(mesh, samples, lit::focus(256));
    double lowest = 1e9;
    for (const Vec3d& s : samples.at)
        lowest = std::min(lowest, s.y);
    EXPECT_NEAR(views.frame.near_h, lowest * 15 / 16, 1e-9);
    for (int k = 0; k < 16; ++k) {
        const LightView view = views.view(k);
        for (const Vec3d p : {Vec3d{0, views.frame.near_h, 0}, Vec3d{5, views.frame.near_h, -7}})
            EXPECT_NEAR((view.to_map * Vec4d{p.x, p.y, p.z, 1}).w, view.near_w, 1e-9);
    }
}

TEST(FocusedViews, NeedLightFromAbove) {
    FocusParams params;
    LightSamples samples = sun_samples({1, -0.01, 0}, 0.2, 4);
    EXPECT_FALSE(can_focus(samples, params));
    samples = parallelogram_samples({0, 1, 0}, {1, 0, 0}, {0, 4, 0}, 16);
    EXPECT_FALSE(can_focus(samples, params)) << "a half of it is below";
    params.plane_point.y = -2;
    EXPECT_TRUE(can_focus(samples, params));
}

TEST(FocusedViews, MedianPlane) {
    Mesh mesh;
    solids::add(mesh, solids::shifted(box({10, 1, 10}), {0, 0, 0}));
    solids::add(mesh, solids::shifted(box({4, 1, 4}), {0, 6, 0}));
    EXPECT_NEAR(median_plane_point(mesh, {0, 2, 0}).y, 0.5, 1e-9);
    const FocusedViews views = focused_views(mesh, lit::samples_of(Lamp::level, 16), lit::focus(256));
    EXPECT_GT(parallax_texels(mesh, views), 1);
    FocusParams flat = lit::focus(256);
    Mesh ground;
    solids::add(ground, box({10, 0.001, 10}));
    EXPECT_LT(parallax_texels(ground, focused_views(ground, lit::samples_of(Lamp::level, 16), flat)), 0.1);
}

}  // namespace
}  // namespace obscura
