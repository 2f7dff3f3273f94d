// Points of surfaces that shine: on them, evenly spread, whatever triangles they are made of.

#include "core/emitter_surface.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace obscura {
namespace {

void add_triangle(Mesh& mesh, Vec3f a, Vec3f b, Vec3f c, std::uint32_t material) {
    const auto v = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3f p : {a, b, c})
        mesh.positions.push_back(p);
    mesh.triangles.push_back({{v, v + 1, v + 2}});
    mesh.material.push_back(material);
}

/// The unit square at z = 0, of 2 n^2 triangles in a shuffled order, sides of which differ by a power.
Mesh square(int n, double power) {
    Mesh mesh;
    std::vector<std::array<Vec3f, 3>> all;
    const auto at = [&](int i) { return static_cast<float>(std::pow(static_cast<double>(i) / n, power)); };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const Vec3f a{at(i), at(j), 0}, b{at(i + 1), at(j), 0}, c{at(i + 1), at(j + 1), 0},
                d{at(i), at(j + 1), 0};
            all.push_back({a, b, c});
            all.push_back({a, c, d});
        }
    }
    std::shuffle(all.begin(), all.end(), std::mt19937(5));
    for (const auto& t : all)
        add_triangle(mesh, t[0], t[1], t[2], 1);
    return mesh;
}

TEST(EmitterSurface, TakesWhatHasTheMaterialAndAnArea) {
    Mesh mesh = square(3, 1);
    add_triangle(mesh, {5, 0, 0}, {9, 0, 0}, {5, 4, 0}, 0);
    add_triangle(mesh, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}, 1);
    add_triangle(mesh, {7, 7, 7}, {7, 7, 7}, {7, 7, 7}, 1);
    const EmitterSurface surface = emitter_surface(mesh, 1);
    EXPECT_EQ(surface.pieces.size(), 18u);
    EXPECT_NEAR(surface.area_m2, 1, 1e-6);
    EXPECT_NEAR(length(surface.middle - Vec3d{0.5, 0.5, 0}), 0, 1e-6);
    EXPECT_NEAR(surface.radius_m, std::sqrt(0.5), 1e-6);
    EXPECT_TRUE(emitter_surface(mesh, 2).pieces.empty());
    EXPECT_EQ(emitter_surface(Mesh{}, 0).area_m2, 0);
}

TEST(EmitterSurface, PointsAreEvenlySpreadHoweverItIsDivided) {
    for (const auto& [n, power] : {std::pair{1, 1.0}, {2, 1.0}, {7, 1.0}, {9, 3.0}, {40, 2.0}}) {
        const EmitterSurface surface = emitter_surface(square(n, power), 1);
        for (const int count : {1, 16, 64, 256, 1024}) {
            const std::vector<EmitterPoint> points = emitter_points(surface, count);
            ASSERT_EQ(points.size(), static_cast<std::size_t>(count));
            double shares = 0;
            for (const EmitterPoint& p : points) {
                ASSERT_NEAR(p.position.z, 0, 1e-9);
                ASSERT_NEAR(length(p.normal - Vec3d{0, 0, 1}), 0, 1e-9);
                ASSERT_TRUE(p.position.x > 0 && p.position.x < 1 && p.position.y > 0 && p.position.y < 1);
                EXPECT_NEAR(p.share * count, 1, 0.25);
                shares += p.share;
            }
            EXPECT_NEAR(shares, 1, 1e-9);
            for (const int stride : {1, 4, 16}) {
                if (count / stride < 16) continue;
                for (int first = 0; first < stride; ++first) {
                    // Sixteenths of the square.
                    std::array<int, 16> cells{};
                    for (int k = first; k < count; k += stride) {
                        const Vec3d p = points[static_cast<std::size_t>(k)].position;
                        const auto cell = [](double x) { return static_cast<int>(4 * x); };
                        ++cells[static_cast<std::size_t>(4 * cell(p.y) + cell(p.x))];
                    }
                    // Random points would stray by the square root of a cell's share, two and three times.
                    const double share = count / stride / 16.0;
                    for (const int c : cells)
                        EXPECT_NEAR(c, share, 0.5 * std::sqrt(share) + 0.5)
                            << n << ' ' << count << ' ' << stride;
                }
            }
        }
    }
}

TEST(EmitterSurface, EveryPieceHasItsShare) {
    // A large triangle and a thousandth of it, far off.
    Mesh mesh;
    add_triangle(mesh, {0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 0);
    add_triangle(mesh, {100, 0, 5}, {101, 0, 5}, {100, 0.1f, 5}, 0);
    const EmitterSurface surface = emitter_surface(mesh, 0);
    double far = 0;
    for (const EmitterPoint& p : emitter_points(surface, 4096))
        far += p.position.x > 50 ? p.share : 0;
    EXPECT_NEAR(far, 0.05 / 50.05, 0.5 / 4096);
}

}  // namespace
}  // namespace obscura
