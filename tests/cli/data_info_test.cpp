// The numbers of `obscura info` against the table that came with the real data (its README.md).
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <ostream>

#include "app/cli/info_command.h"
#include "app/models/obj_file.h"
#include "tests/core/shared_folder.h"

namespace obscura {
namespace {

/// One row of the README. Edges are counted the way the row says: on the file's indices, or with equal
/// positions merged.
struct Row {
    const char* file;
    std::size_t triangles, vertices;
    bool by_index;
    std::uint32_t open_edges, multi_edges;
    bool closed;
    Vec3f min, max;
    float tolerance;  ///< the README's rounding
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
    return out << row.file;
}

constexpr Row rows[] = {
    {"cities/vienna_west.obj",
     23774,
     12563,
     false,
     0,
     85,
     true,
     {-151.2f, 0, -275.5f},
     {151.6f, 53.7f, 275.1f},
     0.05f},
    {"cities/delft_buildings.obj",
     6846,
     3741,
     false,
     0,
     655,
     true,
     {-115.1f, 0, -84.1f},
     {115.5f, 8.91f, 83.3f},
     0.05f},
    {"cities/delft_ground.obj",
     30704,
     21136,
     false,
     2251,
     71,
     false,
     {-324.5f, -0.112f, -210.6f},
     {199.8f, 17.2f, 117.0f},
     0.05f},
    {"cities/delfshaven_east.obj",
     23892,
     17112,
     false,
     10820,
     51,
     false,
     {-377.1f, 0, -247.7f},
     {377.9f, 41.2f, 247.2f},
     0.05f},
    {"cities/fzk_house.obj", 12642, 6732, false, 136, 176, false, {-9, 0, -8}, {9, 7.32f, 8}, 0.005f},
    {"cities/fzk_house_fittings.obj",
     8556,
     4422,
     false,
     0,
     1102,
     true,
     {-5.91f, 1, -4.88f},
     {5.88f, 5.5f, 4.88f},
     0.006f},
    {"cities/city_large.obj",
     435152,
     230936,
     false,
     0,
     6648,
     true,
     {-1111.4f, 0, -1235.3f},
     {1235.3f, 53.7f, 1533.1f},
     0.06f},
    {"meshes/bunny.obj",
     69451,
     34834,
     true,
     223,
     0,
     false,
     {-0.0947f, 0.033f, -0.0619f},
     {0.061f, 0.1873f, 0.0588f},
     6e-5f},
    {"meshes/nefertiti.obj",
     99938,
     49971,
     true,
     0,
     0,
     true,
     {-119.3f, -247.3f, -181.2f},
     {119.4f, 247.3f, 181.3f},
     0.06f},
    {"meshes/armadillo.obj",
     86482,
     43243,
     true,
     0,
     0,
     true,
     {-0.4353f, -0.5734f, -0.3795f},
     {0.4033f, 0.4265f, 0.3833f},
     6e-5f},
    {"meshes/dragon_res2.obj",
     202520,
     100207,
     true,
     0,
     2534,
     true,
     {-0.1082f, 0.0527f, -0.0503f},
     {0.0964f, 0.1971f, 0.0411f},
     6e-5f},
    {"meshes/lion_head.obj",
     16674,
     8356,
     true,
     36,
     0,
     false,
     {-0.3712f, -0.4755f, -0.5f},
     {0.3712f, 0.4755f, 0.5f},
     6e-5f},
    {"meshes/fandisk.obj", 12946, 6475, true, 0, 0, true, {0, 12.6f, -2.68f}, {4.83f, 17.9f, 0}, 0.06f},
    {"meshes/beetle.obj",
     38656,
     19885,
     true,
     1136,
     0,
     false,
     {-0.2029f, -0.1693f, -0.5f},
     {0.2029f, 0.1693f, 0.5f},
     6e-5f},
    {"meshes/ficus_tree.obj",
     118876,
     74301,
     true,
     2750,
     73,
     false,
     {-135.1f, 0, -138.4f},
     {139.9f, 500, 145.5f},
     0.06f},
    {"meshes/palm.obj",
     43323,
     55479,
     true,
     54093,
     0,
     false,
     {-305, 0, -350.9f},
     {268.8f, 1200, 253.1f},
     0.06f},
    {"meshes/bicycle.obj", 3976, 2216, true, 354, 0, false, {-19, -12.3f, -59.8f}, {27, 72, 89.3f}, 0.06f},
};

class DataInfo : public testing::TestWithParam<Row> {};

void expect_near(Vec3d actual, Vec3f expected, float tolerance) {
    EXPECT_NEAR(actual.x, expected.x, tolerance);
    EXPECT_NEAR(actual.y, expected.y, tolerance);
    EXPECT_NEAR(actual.z, expected.z, tolerance);
}

TEST_P(DataInfo, AgreesWithTheReadme) {
    const Row row = GetParam();
    const std::filesystem::path file = shared_folder("data") / row.file;
    SKIP_WITHOUT(file);
    const Model model = load_obj(file, FileAccess{file.parent_path(), {}}, Limits{});
    const MeshInfo info = inspect(model);
    EXPECT_EQ(info.triangles, row.triangles);
    EXPECT_EQ(info.vertices, row.vertices);
    const TopologyReport::Edges edges = row.by_index ? info.topology.by_index : info.topology.welded;
    EXPECT_EQ(edges.open, row.open_edges);
    EXPECT_EQ(edges.multi, row.multi_edges);
    EXPECT_EQ(info.open == 0, row.closed) << info.closed << " closed, " << info.open << " open";
    if (row.closed) {
        EXPECT_EQ(info.topology.by_index.open, 0u);
    }
    expect_near(info.min, row.min, row.tolerance);
    expect_near(info.max, row.max, row.tolerance);
    info_command({file, {}, false, {}});
}

INSTANTIATE_TEST_SUITE_P(Readme, DataInfo, testing::ValuesIn(rows), [](const auto& row) {
    std::string name = std::filesystem::path(row.param.file).stem().string();
    return name;
});

}  // namespace
}  // namespace obscura
