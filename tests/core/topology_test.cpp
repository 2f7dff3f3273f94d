#include "core/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "core/edges.h"
#include "tests/core/cube.h"

namespace obscura {
namespace {

/// Box [lo, hi] of 8 shared vertices (bit 0 = x, 1 = y, 2 = z), 12 triangles, seen counter-clockwise from
/// outside.
Mesh box(Vec3f lo, Vec3f hi) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
    }
    for (const auto& q : cube_quads) {
        mesh.triangles.push_back({{q[0], q[1], q[2]}});
        mesh.triangles.push_back({{q[0], q[2], q[3]}});
    }
    return mesh;
}

/// Every triangle with three vertices of its own.
Mesh soup(const Mesh& mesh) {
    Mesh result;
    for (const Triangle& t : mesh.triangles) {
        const auto base = static_cast<std::uint32_t>(result.positions.size());
        for (const std::uint32_t v : t.v)
            result.positions.push_back(mesh.positions[v]);
        result.triangles.push_back({{base, base + 1, base + 2}});
    }
    return result;
}

void add(Mesh& to, const Mesh& part) {
    const auto base = static_cast<std::uint32_t>(to.positions.size());
    to.positions.insert(to.positions.end(), part.positions.begin(), part.positions.end());
    for (Triangle t : part.triangles) {
        for (std::uint32_t& v : t.v)
            v += base;
        to.triangles.push_back(t);
    }
}

std::size_t closed_count(const Mesh& mesh) {
    return static_cast<std::size_t>(std::count_if(mesh.components.begin(), mesh.components.end(),
                                                  [](const Component& c) { return c.closed; }));
}

TEST(Topology, BoxIsOneClosedComponentOfSixFaces) {
    Mesh mesh = box({0, 0, 0}, {1, 2, 3});
    const TopologyReport report = analyse_topology(mesh);
    ASSERT_EQ(mesh.components.size(), 1u);
    EXPECT_TRUE(mesh.components[0].closed);
    EXPECT_FALSE(mesh.components[0].balanced_multi_edges);
    EXPECT_EQ(mesh.components[0].triangles, 12u);
    EXPECT_EQ(mesh.components[0].open_edges, 0u);
    EXPECT_EQ(mesh.faces.size(), 6u);
    EXPECT_EQ(report.by_index.open, 0u);
    EXPECT_EQ(report.degenerate_triangles, 0u);
    EXPECT_DOUBLE_EQ(signed_volumes(mesh)[0], 6.0);
    // The first two triangles are the z = 0 side, seen from -z.
    EXPECT_EQ(mesh.faces[mesh.face[0]].n, (Vec3d{0, 0, -1}));
    EXPECT_EQ(mesh.face[0], mesh.face[1]);
}

TEST(Topology, SoupIsClosedByEqualPositionsAndMinusZeroIsZero) {
    Mesh mesh = soup(box({0, 0, 0}, {1, 1, 1}));
    for (std::size_t v = 0; v < mesh.positions.size(); v += 2) {
        if (mesh.positions[v].x == 0.0f) mesh.positions[v].x = -0.0f;
    }
    const TopologyReport report = analyse_topology(mesh);
    ASSERT_EQ(mesh.components.size(), 1u);
    EXPECT_TRUE(mesh.components[0].closed);
    EXPECT_EQ(mesh.faces.size(), 6u);
    EXPECT_EQ(report.by_index.open, 36u);
    EXPECT_EQ(report.welded.open, 0u);
}

TEST(Topology, MissingAndTurnedTrianglesMakeItOpen) {
    Mesh missing = box({0, 0, 0}, {1, 1, 1});
    missing.triangles.pop_back();
    const TopologyReport report = analyse_topology(missing);
    ASSERT_EQ(missing.components.size(), 1u);
    EXPECT_FALSE(missing.components[0].closed);
    EXPECT_EQ(missing.components[0].open_edges, 3u);
    EXPECT_EQ(report.by_index.open, 3u);

    Mesh turned = box({0, 0, 0}, {1, 1, 1});
    std::swap(turned.triangles[5].v[0], turned.triangles[5].v[1]);
    EXPECT_EQ(analyse_topology(turned).by_index.open, 3u);
    ASSERT_EQ(turned.components.size(), 1u);
    EXPECT_FALSE(turned.components[0].closed);
    EXPECT_EQ(turned.components[0].open_edges, 6u);  // each of the three walked twice the same way
}

TEST(Topology, AFinLeavesTheCubeClosed) {
    Mesh mesh = box({0, 0, 0}, {1, 1, 1});
    mesh.positions.push_back({-1, 0, -1});
    mesh.triangles.push_back({{0, 8, 2}});  // hangs on the edge 0-2
    const TopologyReport report = analyse_topology(mesh);
    ASSERT_EQ(mesh.components.size(), 2u);
    EXPECT_TRUE(mesh.components[0].closed);
    EXPECT_FALSE(mesh.components[0].balanced_multi_edges);
    EXPECT_EQ(mesh.components[0].triangles, 12u);
    EXPECT_FALSE(mesh.components[1].closed);
    EXPECT_EQ(mesh.components[1].open_edges, 3u);
    EXPECT_EQ(report.by_index.multi, 1u);
}

TEST(Topology, AClosedBuildingStaysClosedBesideAnOpenNeighbour) {
    Mesh mesh = box({0, 0, 0}, {1, 1, 1});
    Mesh neighbour = box({1, 0, 0}, {2, 1, 1});
    neighbour.triangles.resize(10);  // lacks its party wall's opposite
    add(mesh, neighbour);
    analyse_topology(mesh);
    ASSERT_EQ(mesh.components.size(), 2u);
    EXPECT_TRUE(mesh.components[0].closed);
    EXPECT_FALSE(mesh.components[1].closed);
}

TEST(Topology, TouchingSolidsOfSharedVerticesAreClosedWithMultiEdges) {
    // Two soups that share a whole wall, in one object: only positions can tell, and four walls meet in an
    // edge.
    Mesh mesh = soup(box({0, 0, 0}, {1, 1, 1}));
    add(mesh, soup(box({1, 0, 0}, {2, 1, 1})));
    const TopologyReport report = analyse_topology(mesh);
    EXPECT_EQ(closed_count(mesh), mesh.components.size());
    EXPECT_EQ(report.welded.multi, 5u) << "four sides of the wall and its diagonal";
    EXPECT_TRUE(std::any_of(mesh.components.begin(), mesh.components.end(),
                            [](const Component& c) { return c.balanced_multi_edges; }));
}

TEST(Topology, DuplicatedSolidIsClosed) {
    Mesh mesh = soup(box({0, 0, 0}, {1, 1, 1}));
    add(mesh, soup(box({0, 0, 0}, {1, 1, 1})));
    analyse_topology(mesh);
    EXPECT_EQ(closed_count(mesh), mesh.components.size());
    EXPECT_TRUE(mesh.components[0].balanced_multi_edges);
}

TEST(Topology, ObjectsAreClosedBeforeTheirNeighboursAreAsked) {
    // Soups in objects of their own: the closed one is settled inside its object.
    Mesh mesh = soup(box({0, 0, 0}, {1, 1, 1}));
    Mesh open = soup(box({1, 0, 0}, {2, 1, 1}));
    open.triangles.resize(9);
    add(mesh, open);
    mesh.objects = {{"house"}, {"shed"}};
    mesh.object.assign(12, 0);
    mesh.object.resize(21, 1);
    analyse_topology(mesh);
    for (std::size_t t = 0; t < 21; ++t)
        EXPECT_EQ(mesh.components[mesh.component[t]].closed, t < 12) << t;
}

TEST(Topology, PartsOfOneSolidInTwoObjectsCloseTogether) {
    Mesh mesh = soup(box({0, 0, 0}, {1, 1, 1}));
    mesh.objects = {{"walls"}, {"roof"}};
    mesh.object.assign(12, 0);
    mesh.object[3] = mesh.object[7] = 1;
    analyse_topology(mesh);
    ASSERT_EQ(mesh.components.size(), 1u);
    EXPECT_TRUE(mesh.components[0].closed);
}

TEST(Topology, VertexIdsJoinSplitVertices) {
    // A fan on two sides of a uv seam: vertices 1 and 4 are one point of the source.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
    mesh.triangles = {{{0, 1, 2}}, {{4, 3, 2}}};
    const std::vector<std::uint32_t> ids = {7, 900, 3, 5, 900};
    EXPECT_EQ(analyse_topology(mesh, ids).by_index.open, 4u);
    EXPECT_EQ(mesh.components.size(), 1u);
    EXPECT_EQ(mesh.faces.size(), 1u);
}

TEST(Topology, DegenerateTrianglesAreCountedAndKeepTheSolidClosed) {
    Mesh mesh = box({0, 0, 0}, {1, 1, 1});
    // Side z = 0, edge 0-2 gets a middle vertex on the one triangle's side only: a zero-area triangle fills
    // it.
    mesh.positions.push_back({0, 0.5f, 0});
    mesh.triangles[0] = {{0, 8, 3}};
    mesh.triangles.push_back({{8, 2, 3}});
    ASSERT_EQ(mesh.triangles[1], (Triangle{{0, 3, 1}}));
    mesh.triangles.push_back({{0, 2, 8}});
    mesh.triangles.push_back({{1, 1, 3}});  // repeats a corner on an edge
    mesh.triangles.push_back({{6, 6, 6}});  // a point
    const TopologyReport report = analyse_topology(mesh);
    EXPECT_EQ(report.degenerate_triangles, 3u);
    EXPECT_EQ(report.by_index.open, 0u);
    EXPECT_EQ(report.by_index.multi, 0u);
    ASSERT_EQ(mesh.components.size(), 2u);
    EXPECT_TRUE(mesh.components[0].closed);
    EXPECT_EQ(mesh.components[0].triangles, 15u);
    for (const std::uint32_t f : mesh.face)
        EXPECT_LT(f, mesh.faces.size());
}

TEST(Topology, BackToBackSheetsAreClosed) {
    // A double-sided leaf: every triangle balances with its twin, also when they can be told from their
    // places only.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.triangles = {{{0, 1, 2}}, {{0, 2, 3}}, {{2, 1, 0}}, {{3, 2, 0}}};
    for (Mesh leaf : {mesh, soup(mesh)}) {
        analyse_topology(leaf);
        EXPECT_EQ(closed_count(leaf), leaf.components.size());
        EXPECT_EQ(leaf.component[0], leaf.component[2]);
        EXPECT_NE(leaf.face[0], leaf.face[2]) << "one face per side";
    }
}

/// A rotation from a random unit quaternion.
Vec3d rotate(const std::array<double, 4>& q, Vec3d p) {
    const Vec3d u{q[0], q[1], q[2]};
    return p + (cross(u, p) * q[3] + cross(u, cross(u, p))) * 2.0;
}

std::array<double, 4> random_rotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::array<double, 4> q{normal(random), normal(random), normal(random), normal(random)};
    const double len = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& x : q)
        x /= len;
    return q;
}

Mesh random_box(std::mt19937& random) {
    std::uniform_real_distribution<double> size(0.1, 20.0), place(-2000.0, 2000.0);
    Mesh mesh = box({0, 0, 0}, {1, 1, 1});
    const auto q = random_rotation(random);
    const Vec3d s{size(random), size(random), size(random)}, o{place(random), place(random), place(random)};
    for (Vec3f& p : mesh.positions)
        p = to_float(rotate(q, to_double(p) * s) + o);
    return mesh;
}

TEST(Topology, RotatedBoxesHaveSixFacesAndPlanesThroughTheirCorners) {
    std::mt19937 random(1);
    for (int i = 0; i < 500; ++i) {
        Mesh mesh = random_box(random);
        analyse_topology(mesh);
        ASSERT_EQ(mesh.components.size(), 1u);
        EXPECT_TRUE(mesh.components[0].closed);
        ASSERT_EQ(mesh.faces.size(), 6u) << "box " << i;
        for (std::size_t t = 0; t < 12; ++t) {
            EXPECT_EQ(mesh.face[t], t / 2);
            const Plane& plane = mesh.faces[mesh.face[t]];
            EXPECT_NEAR(length(plane.n), 1.0, 0x1p-35);
            for (const std::uint32_t v : mesh.triangles[t].v) {
                EXPECT_NEAR(dot(plane.n, to_double(mesh.positions[v])) + plane.d, 0.0, 4 * 0x1p-23 * 2100);
            }
        }
    }
}

TEST(PlanarFaces, CurvedAndUnconnectedTrianglesDoNotShareAFace) {
    // A ring of 200 wall quads: neighbours turn by 1.8 degrees. And two coplanar boxes that do not touch.
    Mesh ring;
    for (int i = 0; i < 200; ++i) {
        const double a = i * 2 * 3.14159265358979 / 200;
        ring.positions.push_back(to_float(Vec3d{std::cos(a), 0, std::sin(a)}));
        ring.positions.push_back(to_float(Vec3d{std::cos(a), 1, std::sin(a)}));
    }
    for (std::uint32_t i = 0; i < 200; ++i) {
        const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % 200);
        ring.triangles.push_back({{a, a + 1, b}});
        ring.triangles.push_back({{a + 1, b + 1, b}});
    }
    analyse_topology(ring);
    EXPECT_EQ(ring.faces.size(), 200u);

    Mesh two = box({0, 0, 0}, {1, 1, 1});
    add(two, box({5, 0, 0}, {6, 1, 1}));
    analyse_topology(two);
    EXPECT_EQ(two.faces.size(), 12u);
}

TEST(PlanarFaces, AStepSmallerThanTheToleranceKeepsItsOwnPlane) {
    // Far from the origin a riser of two units in the last place: flat to the distance test, upright to the
    // normal test.
    const float y = 1000.0f, step = 2 * 0x1p-14f;
    Mesh mesh;
    mesh.positions = {{0, y, 0},        {1, y, 0},        {1, y, 1},        {0, y, 1},
                      {1, y + step, 0}, {1, y + step, 1}, {2, y + step, 0}, {2, y + step, 1}};
    mesh.triangles = {{{0, 2, 1}}, {{0, 3, 2}}, {{1, 2, 5}}, {{1, 5, 4}}, {{4, 5, 7}}, {{4, 7, 6}}};
    analyse_topology(mesh);
    EXPECT_EQ(mesh.face[0], mesh.face[1]);
    EXPECT_NE(mesh.face[0], mesh.face[2]);
}

/// Boxes, soups, fins, sheets and an open neighbour in one mesh.
Mesh zoo() {
    std::mt19937 random(5);
    Mesh mesh = soup(box({0, 0, 0}, {1, 1, 1}));
    add(mesh, soup(box({1, 0, 0}, {2, 1, 1})));
    for (int i = 0; i < 5; ++i)
        add(mesh, random_box(random));
    Mesh open = box({0, 2, 0}, {1, 3, 1});
    open.triangles.erase(open.triangles.begin() + 4);
    open.positions.push_back({-1, 2, -1});
    open.triangles.push_back({{0, 8, 2}});
    add(mesh, open);
    return mesh;
}

TEST(Topology, OrderOfTrianglesAndCornersDoesNotMatter) {
    Mesh mesh = zoo();
    analyse_topology(mesh);
    std::mt19937 random(9);
    for (int round = 0; round < 20; ++round) {
        std::vector<std::uint32_t> order = all_indices(mesh.triangles.size());
        std::shuffle(order.begin(), order.end(), random);
        Mesh shuffled;
        shuffled.positions = mesh.positions;
        for (const std::uint32_t t : order) {
            Triangle triangle = mesh.triangles[t];
            std::rotate(triangle.v, triangle.v + random() % 3, triangle.v + 3);
            shuffled.triangles.push_back(triangle);
        }
        analyse_topology(shuffled);
        ASSERT_EQ(shuffled.components.size(), mesh.components.size());
        ASSERT_EQ(shuffled.faces.size(), mesh.faces.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Component& a = shuffled.components[shuffled.component[i]];
            const Component& b = mesh.components[mesh.component[order[i]]];
            EXPECT_EQ(a.closed, b.closed);
            EXPECT_EQ(a.triangles, b.triangles);
            EXPECT_EQ(a.open_edges, b.open_edges);
            EXPECT_EQ(a.balanced_multi_edges, b.balanced_multi_edges);
            EXPECT_EQ(shuffled.faces[shuffled.face[i]].n, mesh.faces[mesh.face[order[i]]].n);
            EXPECT_EQ(shuffled.faces[shuffled.face[i]].d, mesh.faces[mesh.face[order[i]]].d);
        }
    }
}

TEST(AppendMesh, RenumbersEverything) {
    Mesh a = box({0, 0, 0}, {1, 1, 1}), b = soup(box({3, 0, 0}, {4, 1, 1}));
    a.objects = {{"a"}};
    a.object.assign(12, 0);
    a.material.assign(12, 2);
    b.uvs.assign(b.positions.size(), {0.5f, 0.25f});
    b.triangles.pop_back();
    analyse_topology(a);
    analyse_topology(b);
    Mesh both;
    append_mesh(both, a);
    append_mesh(both, b);
    EXPECT_EQ(both.triangles.size(), 23u);
    EXPECT_EQ(both.positions.size(), 44u);
    ASSERT_EQ(both.uvs.size(), 44u);
    EXPECT_EQ(both.uvs[7], (Vec2f{0, 0}));
    EXPECT_EQ(both.uvs[8], (Vec2f{0.5f, 0.25f}));
    ASSERT_EQ(both.objects.size(), 2u);
    EXPECT_EQ(both.object[0], 0u);
    EXPECT_EQ(both.object[22], 1u);
    EXPECT_EQ(both.material[0], 2u);
    EXPECT_EQ(both.material[22], 0u);
    EXPECT_TRUE(both.components[both.component[3]].closed);
    EXPECT_FALSE(both.components[both.component[14]].closed);
    EXPECT_EQ(both.faces.size(), 12u);
    EXPECT_EQ(both.positions[both.triangles[22].v[0]], b.positions[b.triangles[10].v[0]]);
}

}  // namespace
}  // namespace obscura
