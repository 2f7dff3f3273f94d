#include "core/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace obscura {
namespace {

using Outline = std::vector<Vec2d>;

double shoelace(const Outline& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2d a = p[i], b = p[(i + 1) % p.size()];
        sum += a.x * b.y - a.y * b.x;
    }
    return sum / 2;
}

std::vector<Vec3f> in_plane(const Outline& outline) {
    // A plane that is steep in all axes: x right, y up, z follows.
    std::vector<Vec3f> corners;
    for (const Vec2d& p : outline)
        corners.push_back(to_float(Vec3d{p.x, p.y, 0.5 * p.x - 0.25 * p.y}));
    return corners;
}

/// Cuts the outline and checks that positive triangles tile it: n - 2 of them, none flat, areas add up.
void expect_tiled(const Outline& outline, double tolerance = 1e-5) {
    const std::vector<Vec3f> corners = in_plane(outline);
    const auto triangles = triangulate_polygon(corners);
    ASSERT_EQ(triangles.size(), outline.size() - 2);
    const double whole = shoelace(outline);
    double sum = 0;
    for (const auto& t : triangles) {
        const auto p = [&](std::size_t k) {
            return Vec2d{to_double(corners[t[k]]).x, to_double(corners[t[k]]).y};
        };
        const double area = shoelace({p(0), p(1), p(2)});
        EXPECT_GT(area * whole, 0) << "flat or turned triangle";
        sum += area;
    }
    EXPECT_NEAR(sum, whole, tolerance * std::fabs(whole));
}

TEST(Polygon, ConcaveAndCollinear) {
    expect_tiled({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}});
    expect_tiled({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}});
    expect_tiled({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {2, 3}});
    expect_tiled({{0, 0}, {0, 4}, {4, 4}, {4, 3}, {1, 3}, {1, 1}, {4, 1}, {4, 0}});  // C, clockwise
}

TEST(Polygon, ABridgeToAHole) {
    // A square with a square hole, the bridge walked there and back.
    expect_tiled({{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}});
}

TEST(Polygon, ThreeHundredCorners) {
    Outline circle, star;
    for (int i = 0; i < 300; ++i) {
        const double a = i * 2 * 3.14159265358979 / 300;
        circle.push_back({std::cos(a), std::sin(a)});
        const double r = i % 2 ? 1.0 : 3.0;
        star.push_back({r * std::cos(a), r * std::sin(a)});
    }
    expect_tiled(circle);
    expect_tiled(star);
}

TEST(Polygon, RandomSimplePolygonsAreTiled) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int round = 0; round < 400; ++round) {
        // Star-shaped: sorted angles, wild radii. Monotone: a zigzag above and one below a line.
        const int n = 4 + static_cast<int>(random() % 60);
        Outline star;
        for (int i = 0; i < n; ++i) {
            const double a = (i + 0.9 * unit(random)) * 2 * 3.14159265358979 / n, r = 0.05 + unit(random);
            star.push_back({r * std::cos(a), r * std::sin(a)});
        }
        expect_tiled(star, 1e-4);
        Outline monotone;
        for (int i = 0; i < n; ++i)
            monotone.push_back({i + 0.9 * unit(random), -0.01 - 10 * unit(random)});
        for (int i = n - 1; i >= 0; --i)
            monotone.push_back({i + 0.9 * unit(random), 0.01 + 10 * unit(random)});
        if (round % 2) std::reverse(monotone.begin(), monotone.end());
        expect_tiled(monotone, 1e-4);
    }
}

TEST(Polygon, StaircasesWithPointsOnStraightSidesAreTiled) {
    // Integer outlines are exact, and full of corners in line: columns of random height over a floor.
    std::mt19937 random(4);
    for (int round = 0; round < 200; ++round) {
        const int columns = 2 + static_cast<int>(random() % 12);
        Outline outline;
        for (int i = 0; i <= columns; ++i)
            outline.push_back({static_cast<double>(i), 0});
        for (int i = columns; i > 0; --i) {
            const auto h = static_cast<double>(1 + random() % 4);
            outline.push_back({static_cast<double>(i), h});
            outline.push_back({static_cast<double>(i - 1), h});
        }
        // Equal neighbours repeat a point; keep it once.
        outline.erase(std::unique(outline.begin(), outline.end()), outline.end());
        expect_tiled(outline);
    }
}

TEST(Polygon, CrossingAndFlatOutlinesGiveTheSameTrianglesEveryTime) {
    const std::vector<Outline> bad = {{{0, 0}, {1, 1}, {1, 0}, {0, 1}},
                                      {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1, 0}},
                                      {{1, 1}, {1, 1}, {1, 1}, {1, 1}},
                                      {{0, 0}, {5, 5}, {5, 0}, {0, 5}, {3, 9}, {3, -9}}};
    for (const Outline& outline : bad) {
        const auto once = triangulate_polygon(in_plane(outline));
        EXPECT_EQ(once.size(), outline.size() - 2);
        EXPECT_EQ(once, triangulate_polygon(in_plane(outline)));
    }
}

}  // namespace
}  // namespace obscura
