// Ground as a mesh is what topology would have found it to be.

#include "raster/heights/height_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/topology.h"
#include "tests/heights/drawn_heights.h"

namespace obscura {
namespace {

TEST(HeightMesh, IsOneClosedSolidAsTopologyFindsIt) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        drawn::Random random(seed);
        const HeightField field = drawn::heights(random, 14);
        if (field.width() < 2 || field.height() < 2) continue;
        const Mesh mesh = height_mesh(field, {{5, 7, 9}, 3});
        ASSERT_EQ(static_cast<std::int64_t>(mesh.triangles.size()),
                  height_mesh_triangles(field.width(), field.height()));
        ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
        ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
        Mesh found = mesh;
        const TopologyReport report = analyse_topology(found);
        EXPECT_EQ(report.welded.open, 0u);
        EXPECT_EQ(report.welded.multi, 0u);
        EXPECT_EQ(report.degenerate_triangles, 0u);
        ASSERT_EQ(found.components.size(), 1u);
        EXPECT_TRUE(found.components[0].closed);
        ASSERT_EQ(mesh.components.size(), 1u);
        EXPECT_TRUE(mesh.components[0].closed);
        EXPECT_EQ(mesh.components[0].triangles, found.components[0].triangles);
        EXPECT_EQ(mesh.component, found.component);
        ASSERT_EQ(mesh.face.size(), mesh.triangles.size());
        ASSERT_EQ(mesh.faces.size(), mesh.triangles.size());

        // Its volume is that under the triangles: the mean of three heights over each half cell.
        double volume = 0;
        const double floor_m = metres_of(height_range(field).least_q16) - 3;
        const auto above = [&](int x, int y) { return metres_of(field.height_q16(x, y)) - floor_m; };
        for (int y = 0; y + 1 < field.height(); ++y) {
            for (int x = 0; x + 1 < field.width(); ++x) {
                const double a = above(x, y), b = above(x + 1, y), c = above(x, y + 1),
                             d = above(x + 1, y + 1);
                const double twice =
                    field.diagonal == Diagonal::falling ? 2 * a + b + c + 2 * d : a + 2 * b + 2 * c + d;
                volume += twice / 6 * field.cell_x_m * field.cell_y_m;
            }
        }
        EXPECT_NEAR(signed_volumes(mesh)[0] / volume, 1, 1e-4) << "seed " << seed;
    }
}

TEST(HeightMesh, StandsWithNorthAtMinusZ) {
    HeightField field{Image<std::int32_t>(5, 3), 2, 10, Diagonal::falling};
    field.height_q16(4, 0) = height_q16_of(6);
    const Mesh mesh = height_mesh(field, {{100, 50, -7}, 1});
    // The north-eastern sample.
    EXPECT_EQ(mesh.positions[4], (Vec3f{104, 56, -17}));
    EXPECT_EQ(mesh.positions[5 + 2], (Vec3f{100, 50, -7})) << "the middle";
    EXPECT_EQ(mesh.normals[0], (Vec3f{0, 1, 0}));
    EXPECT_LT(mesh.normals[4].x, 0) << "rising to the east";
    EXPECT_GT(mesh.normals[4].z, 0) << "and to the north";
    for (std::size_t t = 0; t < 16; ++t)
        EXPECT_GT(mesh.faces[t].n.y, 0) << "the ground faces up";
}

}  // namespace
}  // namespace obscura
