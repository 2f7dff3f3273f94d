#include "scenes/shapes.h"

#include <gtest/gtest.h>

#include "scenes/build.h"
#include "scenes/polygon.h"
#include "tests/core/mesh_checks.h"

namespace obscura {
namespace {

using namespace mesh_checks;

constexpr double pi = 3.14159265358979323846;

void expect_one_solid(const Mesh& mesh) {
    const Verdict v = inspect(mesh);
    EXPECT_TRUE(v.arrays_agree);
    EXPECT_EQ(v.solids, 1u);
    EXPECT_EQ(v.open_parts, 0u);
    EXPECT_EQ(v.inside_out, 0u);
    EXPECT_EQ(v.degenerate, 0u);
    EXPECT_EQ(v.bad_normals, 0u);
    EXPECT_EQ(count_edges(parts(mesh).front()).multiple, 0);
}

TEST(Checks, SeeAHoleAFlipAndASliver) {
    Mesh holed = box({1, 1, 1});
    holed.triangles.pop_back(), holed.material.pop_back(), holed.object.pop_back();
    EXPECT_EQ(inspect(holed).open_parts, 1u);
    Mesh flipped = box({1, 1, 1});
    for (Triangle& t : flipped.triangles)
        std::swap(t.v[1], t.v[2]);
    EXPECT_EQ(inspect(flipped).inside_out, 1u);
    EXPECT_GT(inspect(flipped).bad_normals, 0u);
    Mesh sliver = box({1, 1, 1});
    sliver.positions[2] = sliver.positions[0];
    EXPECT_GT(inspect(sliver).degenerate, 0u);
}

TEST(Shapes, BoxIsExact) {
    const Mesh mesh = box({-1, 0, 2}, {1, 3, 2.5});
    expect_one_solid(mesh);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_DOUBLE_EQ(volume(mesh), 3.0);
    EXPECT_DOUBLE_EQ(area(mesh), 2 * (2 * 3 + 2 * 0.5 + 3 * 0.5));
}

TEST(Shapes, PlaneIsAnOpenSheetThatFacesUp) {
    const Mesh mesh = plane(4, 3, 5, 7);
    const Verdict v = inspect(mesh);
    EXPECT_EQ(v.open_parts, 1u);
    EXPECT_EQ(v.bad_normals, 0u);
    EXPECT_EQ(mesh.triangles.size(), 2u * 5 * 7);
    EXPECT_NEAR(area(mesh), 12.0, 1e-5);
    EXPECT_EQ(mesh.normals.front(), (Vec3f{0, 1, 0}));
}

TEST(Shapes, SphereConvergesWithTheSquareOfItsRings) {
    double last_error = 1;
    for (const int rings : {8, 16, 32, 64}) {
        const Mesh mesh = sphere(2.0, 2 * rings, rings);
        expect_one_solid(mesh);
        const double error = 1 - volume(mesh) / (4.0 / 3.0 * pi * 8);
        EXPECT_GT(error, 0);
        EXPECT_LT(error, 0.3 * last_error) << rings;
        last_error = error;
    }
    EXPECT_LT(last_error, 2e-3);
    EXPECT_NEAR(area(sphere(2.0, 128, 64)), 4 * pi * 4, 0.06);
}

TEST(Shapes, CylinderHasTheVolumeOfItsPolygonalPrism) {
    for (const int n : {3, 7, 48}) {
        const Mesh mesh = cylinder(0.5, 3, n);
        expect_one_solid(mesh);
        EXPECT_NEAR(volume(mesh), 3 * 0.5 * n * 0.25 * std::sin(2 * pi / n), 1e-5) << n;
    }
    expect_one_solid(frustum(1, 0, 2));
    expect_one_solid(frustum(0, 1, 2));
    EXPECT_NEAR(volume(frustum(2, 1, 3, 2048)), pi * 3 * (4 + 2 + 1) / 3, 1e-3);
}

TEST(Shapes, LatheShadesSmoothRoundTheAxisAndKeepsSharpRims) {
    const Mesh mesh = cylinder(1, 1, 12);
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const Vec3f n = mesh.normals[i], p = mesh.positions[i];
        const bool cap = std::fabs(n.y) > 0.5f;
        EXPECT_NEAR(cap ? std::fabs(n.y) : n.x * p.x + n.z * p.z, 1.0f, 1e-6f);
    }
}

TEST(Shapes, TorusVolumeIsPappuss) {
    const Mesh mesh = torus(2, 0.5, 256, 128);
    expect_one_solid(mesh);
    EXPECT_NEAR(volume(mesh), 2 * pi * pi * 2 * 0.25, 0.01);
}

TEST(Shapes, ExtrudedStarIsClosedAndHasItsArea) {
    std::vector<Vec2d> star;
    for (int i = 0; i < 10; ++i)
        star.push_back(on_circle(i / 10.0) * (i % 2 ? 0.4 : 1.0));
    const Mesh mesh = extrude(star, -1, 2);
    expect_one_solid(mesh);
    const double outline_area = 10 * 0.5 * 1.0 * 0.4 * std::sin(2 * pi / 10);
    EXPECT_NEAR(volume(mesh), 3 * outline_area, 1e-5);
}

TEST(Shapes, ArchStripIsClosedAndHasItsVolume) {
    std::vector<Vec2d> lower, upper;
    for (int i = 0; i <= 64; ++i) {
        const Vec2d c = on_circle(0.5 - 0.5 * i / 64);
        lower.push_back(c), upper.push_back(c * 1.25);
    }
    const Mesh mesh = strip(lower, upper, 0, 0.5);
    expect_one_solid(mesh);
    EXPECT_NEAR(volume(mesh), 0.5 * pi / 2 * (1.25 * 1.25 - 1), 1e-3);
}

TEST(Shapes, NosesOnOneLineAreCutToo) {
    // The profile of a flight of stairs; rounding makes its noses turn either way.
    for (const double going : {0.1, 0.104, 0.12, 0.298, 1.0 / 3}) {
        for (const double rise : {0.06, 0.165, 0.471}) {
            const int steps = 12;
            std::vector<Vec2d> profile{{0, 0}, {steps * going, 0}};
            for (int i = steps; i > 0; --i) {
                profile.push_back({i * going, i * rise});
                profile.push_back({(i - 1) * going, i * rise});
            }
            profile.pop_back();
            profile.push_back({0, rise});
            double area = 0;
            const std::vector<Triangle> triangles = triangulate(profile);
            for (const Triangle& t : triangles) {
                const Vec2d a = profile[t.v[0]], b = profile[t.v[1]], c = profile[t.v[2]];
                const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
                EXPECT_GT(twice, 0.01 * going * rise);
                area += 0.5 * twice;
            }
            EXPECT_EQ(triangles.size(), 2u * steps);
            EXPECT_NEAR(area, 0.5 * steps * (steps + 1) * going * rise, 1e-9);
            expect_one_solid(extrude(profile, -1, 1));
        }
    }
}

TEST(Shapes, BentTubeIsClosed) {
    const Mesh mesh =
        tube({{{0, 0, 0}, 0.2}, {{0, 1, 0}, 0.15}, {{0.5, 1.5, 0}, 0.1}, {{1.5, 1.5, 0.4}, 0.05}}, 7);
    expect_one_solid(mesh);
    const Mesh straight = tube({{{0, 0, 0}, 1}, {{0, 0, 4}, 1}}, 360);
    EXPECT_NEAR(volume(straight), 4 * pi, 1e-2);
}

TEST(Shapes, MouldingRunsRoundWithMitres) {
    const Mesh mesh = moulding({{0, 0}, {0.2, 0}, {0.2, 0.1}, {0, 0.1}}, 4, 3);
    expect_one_solid(mesh);
    EXPECT_NEAR(volume(mesh), 0.1 * (4.4 * 3.4 - 4 * 3), 1e-5);
}

TEST(Build, MirroringAndStretchingKeepASolidRight) {
    Mesh mesh;
    add_part(mesh, sphere(1, 16, 8), scaling({-1, 2, 0.5}) * rotation_x(30), 3);
    expect_one_solid(mesh);
    EXPECT_NEAR(volume(mesh), volume(sphere(1, 16, 8)), 1e-5);
    EXPECT_EQ(mesh.material.front(), 3u);
}

TEST(Build, RotationToTurnsUpToAnyDirection) {
    for (const Vec3d to : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, normalize(Vec3d{1, 2, -3}), Vec3d{0, 1, 0}}) {
        const Affine turn = rotation_to(to);
        EXPECT_NEAR(length(transform_direction(turn, {0, 1, 0}) - to), 0, 1e-12);
        EXPECT_NEAR(determinant(turn), 1, 1e-12);
    }
}

}  // namespace
}  // namespace obscura
