#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/topology.h"
#include "tests/core/cube.h"

namespace obscura {
namespace {

/// Unit cube; `other_diagonals` cuts some sides the other way.
Mesh cube(unsigned other_diagonals = 0) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.push_back(
            {static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2 & 1)});
    }
    for (unsigned f = 0; f < 6; ++f) {
        const auto& q = cube_quads[f];
        const unsigned s = other_diagonals >> f & 1;
        mesh.triangles.push_back({{q[s], q[s + 1], q[s + 2]}});
        mesh.triangles.push_back({{q[s], q[s + 2], q[(s + 3) % 4]}});
    }
    return mesh;
}

/// Latitude-longitude sphere of radius 2 with shared vertices.
Mesh sphere(int rings, int sides) {
    Mesh mesh;
    const double pi = 3.14159265358979;
    for (int r = 0; r <= rings; ++r) {
        for (int s = 0; s < sides; ++s) {
            const double a = pi * r / rings, b = 2 * pi * s / sides;
            const double radius = r == rings ? 0 : 2 * std::sin(a);  // one point at either pole
            mesh.positions.push_back(
                to_float(Vec3d{radius * std::cos(b), 2 * std::cos(a), -radius * std::sin(b)}));
        }
    }
    for (int r = 0; r < rings; ++r) {
        for (int s = 0; s < sides; ++s) {
            const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(i * sides + j % sides); };
            mesh.triangles.push_back({{id(r, s), id(r + 1, s), id(r + 1, s + 1)}});
            mesh.triangles.push_back({{id(r, s), id(r + 1, s + 1), id(r, s + 1)}});
        }
    }
    return mesh;
}

void expect_unit_normals(const Mesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const Vec3f& n : mesh.normals)
        EXPECT_NEAR(length(n), 1.0f, 1e-6f);
}

TEST(Normals, CreasesSplitACubeIntoSixSides) {
    Mesh mesh = cube();
    mesh.uvs.resize(8);
    for (std::size_t v = 0; v < 8; ++v)
        mesh.uvs[v] = {static_cast<float>(v), 0};
    const Mesh before = mesh;
    compute_normals(mesh, 40);
    EXPECT_EQ(mesh.positions.size(), 24u);
    ASSERT_EQ(mesh.uvs.size(), 24u);
    expect_unit_normals(mesh);
    for (std::size_t t = 0; t < 12; ++t) {
        const Triangle &now = mesh.triangles[t], &was = before.triangles[t];
        const Vec3f a = mesh.positions[now.v[0]], b = mesh.positions[now.v[1]], c = mesh.positions[now.v[2]];
        const Vec3f facet = normalize(cross(b - a, c - a));
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(mesh.normals[now.v[k]], facet);
            EXPECT_EQ(mesh.positions[now.v[k]], before.positions[was.v[k]]);
            EXPECT_EQ(mesh.uvs[now.v[k]], before.uvs[was.v[k]]);
        }
    }
}

TEST(Normals, AngleWeightsDoNotSeeHowTheSidesAreCut) {
    for (const unsigned diagonals : {0u, 63u, 21u, 37u}) {
        Mesh mesh = cube(diagonals);
        compute_normals(mesh, 180);
        ASSERT_EQ(mesh.positions.size(), 8u);
        for (std::size_t v = 0; v < 8; ++v) {
            const Vec3f outward = normalize(mesh.positions[v] - Vec3f{0.5f, 0.5f, 0.5f});
            EXPECT_NEAR(dot(mesh.normals[v], outward), 1.0f, 1e-6f)
                << "diagonals " << diagonals << " vertex " << v;
        }
    }
}

TEST(Normals, SphereIsSmooth) {
    Mesh mesh = sphere(24, 48);
    compute_normals(mesh, 30);
    expect_unit_normals(mesh);
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t.v) {
            const Vec3f p = mesh.positions[v];
            EXPECT_GT(dot(normalize(p), mesh.normals[v]), 0.999f);
        }
    }
}

TEST(Normals, SplitVerticesSmoothAcrossTheSeam) {
    // Two triangles of a gentle roof, nothing shared but positions.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0.1f, 0}, {0, 0, 1}, {0, 0, 0}, {-1, 0.1f, 0}};
    mesh.triangles = {{{0, 1, 2}}, {{3, 4, 5}}};
    compute_normals(mesh, 40);
    EXPECT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.normals[0], mesh.normals[4]);
    EXPECT_EQ(mesh.normals[1], mesh.normals[3]);
    EXPECT_NE(mesh.normals[2], mesh.normals[5]);
    Mesh sharp = mesh;
    sharp.normals.clear();
    compute_normals(sharp, 5);
    EXPECT_NE(sharp.normals[0], sharp.normals[4]);
}

TEST(Normals, GivenOnesStayAndGapsAreFilled) {
    Mesh mesh = cube();
    mesh.normals.assign(8, {});
    mesh.normals[3] = {0, 0, 1};
    compute_normals(mesh, 40);
    EXPECT_EQ(mesh.normals[3], (Vec3f{0, 0, 1}));
    EXPECT_EQ(mesh.positions.size(), 8u + 7u * 2u);
    expect_unit_normals(mesh);
}

TEST(Normals, SmoothingGroupsOverrideTheAngle) {
    std::vector<std::uint32_t> groups(12, 1);
    Mesh all_smooth = cube();
    compute_normals(all_smooth, 0, groups);
    EXPECT_EQ(all_smooth.positions.size(), 8u);

    groups.assign(12, smooth_none);
    Mesh flat = sphere(8, 8);
    groups.assign(flat.triangles.size(), smooth_none);
    compute_normals(flat, 180, groups);
    for (const Triangle& t : flat.triangles) {
        const Vec3f a = flat.positions[t.v[0]], b = flat.positions[t.v[1]], c = flat.positions[t.v[2]];
        if (length(cross(b - a, c - a)) < 1e-5f) continue;
        for (const std::uint32_t v : t.v)
            EXPECT_GT(dot(flat.normals[v], normalize(cross(b - a, c - a))), 0.99999f);
    }

    // Bottom and top halves in groups of their own: a crease between them and nowhere else.
    Mesh halves = cube();
    groups = {1, 1, 1, 1, 1, 1, 2, 2, 1, 1, 1, 1};
    compute_normals(halves, 0, groups);
    EXPECT_EQ(halves.positions.size(), 12u);
}

TEST(Normals, DegenerateTrianglesHarmNothing) {
    Mesh mesh = cube();
    mesh.triangles.push_back({{0, 0, 5}});
    mesh.positions.push_back({9, 9, 9});
    mesh.triangles.push_back({{8, 8, 8}});
    mesh.positions.push_back({7, 7, 7});  // nobody's
    compute_normals(mesh, 40);
    expect_unit_normals(mesh);
    Mesh plain = cube();
    compute_normals(plain, 40);
    for (std::size_t t = 0; t < 12; ++t) {
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(mesh.normals[mesh.triangles[t].v[k]], plain.normals[plain.triangles[t].v[k]]);
        }
    }
}

TEST(Normals, ComponentsDoNotSmoothEachOther) {
    // Two sheets that meet at a gentle angle, told apart by their components.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0.1f, 0}, {-1, 0.1f, 0}};
    mesh.triangles = {{{0, 1, 2}}, {{1, 0, 3}}};
    mesh.component = {0, 1};
    mesh.components.resize(2);
    compute_normals(mesh, 90);
    EXPECT_EQ(mesh.positions.size(), 6u);
}

}  // namespace
}  // namespace obscura
