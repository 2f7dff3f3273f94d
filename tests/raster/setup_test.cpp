// Setup: clipping keeps surfaces whole, culling drops what it says, planes are shared.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>

#include "raster/bin.h"
#include "raster/coverage.h"
#include "raster/depth_map.h"
#include "raster/view.h"
#include "tests/raster/raster_oracle.h"
#include "tests/raster/raster_solids.h"

namespace obscura {
namespace {

std::vector<TriangleRecord> records_of(const Mesh& mesh, const View& view, const SetupParams& params = {},
                                       const Exec& exec = {Isa::ref, 1}) {
    TriangleSetup setup;
    setup_triangles(mesh, view, params, exec, setup);
    std::vector<TriangleRecord> records;
    for (const RecordBlock& b : setup.blocks) {
        for (std::size_t i = b.begin; i < b.begin + b.count; ++i)
            records.push_back(setup.records[i]);
    }
    return records;
}

int hits(const std::vector<TriangleRecord>& records, int x, int y) {
    int n = 0;
    for (const TriangleRecord& t : records) {
        n += oracle::covers(t.x, t.y, std::int64_t{x} * 256 + 128, std::int64_t{y} * 256 + 128);
    }
    return n;
}

TEST(Clip, GroundToTheHorizonIsCoveredExactlyOnce) {
    // A sheet of 200 km, in many triangles so that their edges are clipped too, around a camera at eye
    // height.
    for (const int cells : {1, 7}) {
        Mesh mesh = plane(200000, 200000, cells, cells);
        analyse_topology(mesh);
        for (const double pitch : {0.0, -0.2, -0.7}) {
            for (const double heading : {0.0, 0.4, 1.3, 2.2}) {
                Camera camera;
                camera.eye = {3.3, 1.7, -2.1};
                // A direction by the rational circle, no trigonometry.
                const double c = (1 - heading * heading) / (1 + heading * heading),
                             s = 2 * heading / (1 + heading * heading);
                camera.look_at = camera.eye + Vec3d{s, pitch, -c};
                camera.vfov_deg = 75;
                const View view = camera_view(camera, 160, 90);
                const auto records = records_of(mesh, view);
                const Mat4 to_world = inverse(view.to_map);
                for (int y = 0; y < 90; ++y) {
                    for (int x = 0; x < 160; ++x) {
                        // The ray through the pixel's centre: two points of it, from two depths.
                        const Vec4d p = to_world * Vec4d{x + 0.5, y + 0.5, -1, 1};
                        const double down = p.y / p.w - camera.eye.y;
                        // Rays that meet the ground between 1 m and 50 km must hit; rays upwards must not.
                        const double reach = -camera.eye.y / down * camera.near_m;
                        if (down < 0 && reach < 50000) {
                            ASSERT_EQ(hits(records, x, y), 1) << x << "," << y;
                        }
                        if (down >= 0) {
                            ASSERT_EQ(hits(records, x, y), 0) << x << "," << y;
                        }
                    }
                }
            }
        }
    }
}

TEST(Clip, SolidsFarOffTheMapStayBalanced) {
    // A long box whose ends lie beyond the guard band of a small, close view.
    Mesh mesh;
    solids::add(mesh, solids::moved(box(Vec3d{40000, 0.3, 0.4}), solids::rotation({0.2, 1, 0.1}, 0.21)));
    solids::add(mesh, solids::moved(box(Vec3d{0.5, 30000, 0.4}), solids::rotation({0.2, 0.1, 1}, 0.33)));
    LightView view;
    view.width = view.height = 128;
    view.to_map = {{{90, 0, 0, 64}, {0, 0, 90, 64}, {0, -1e-5, 0, 0.5}, {0, 0, 0, 1}}};
    const auto records = records_of(mesh, view);
    int covered = 0;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            int sum = 0;
            const auto list = oracle::hits_at(records, x, y);
            for (const oracle::Hit& h : list)
                sum += 1 - h.kind;
            ASSERT_EQ(sum, 0) << x << "," << y;
            covered += !list.empty();
        }
    }
    EXPECT_GT(covered, 1000);
}

TEST(Setup, RecordsAreTheSameBytesOnEveryIsaAndThreadCount) {
    const Mesh mesh = solids::random_solids(5, 50, true, true);
    Camera camera;
    camera.eye = {1, 0.5, 2};
    camera.look_at = {0, 0, 0};
    for (const View& view : {camera_view(camera, 640, 360),
                             orthographic_light_view(bounds_of(mesh), normalize(Vec3d{1, -2, 0.5}), 1024)}) {
        const auto expected = records_of(mesh, view, {}, {Isa::ref, 1});
        ASSERT_GT(expected.size(), 300u);
        for (const Isa isa : supported_isas()) {
            for (const int threads : {1, 3}) {
                const auto actual = records_of(mesh, view, {}, {isa, threads});
                ASSERT_EQ(actual.size(), expected.size());
                ASSERT_EQ(std::memcmp(actual.data(), expected.data(), actual.size() * sizeof(TriangleRecord)),
                          0)
                    << isa_name(isa);
            }
        }
    }
}

TEST(Setup, CullingDropsWhatItSays) {
    Mesh mesh;
    solids::add(mesh, box(Vec3d{1, 1, 1}));
    solids::add(mesh, solids::shifted(plane(1, 1), {3, 0, 0}));
    solids::add(mesh, solids::shifted(solids::flipped(plane(1, 1)), {6, 0, 0}));
    const LightView view = orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.3, -1, 0.2}), 256);
    const auto count = [&](Culling culling) { return records_of(mesh, view, {false, culling, true}).size(); };
    EXPECT_EQ(count(Culling::none), 12u + 2 + 2);
    EXPECT_EQ(count(Culling::back_faces), 6u + 2);
    mesh.objects[mesh.object.front()].casts_shadow = false;
    EXPECT_EQ(records_of(mesh, view, {true, Culling::none, true}).size(), 4u);
}

TEST(Setup, TrianglesOfOnePlanarFaceShareOnePlane) {
    Mesh mesh;
    solids::add(mesh, solids::moved(box(Vec3d{2, 1, 3}), solids::rotation({0.3, 1, 0.2}, 0.37)));
    const auto records = records_of(mesh, orthographic_light_view(bounds_of(mesh), {0, -1, 0}, 256));
    ASSERT_EQ(records.size(), 12u);
    for (std::size_t i = 0; i < records.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const bool same_face = mesh.face[records[i].triangle] == mesh.face[records[j].triangle];
            const bool same_plane = records[i].a == records[j].a && records[i].b == records[j].b &&
                                    records[i].c == records[j].c && records[i].zmin == records[j].zmin &&
                                    records[i].zmax == records[j].zmax;
            EXPECT_EQ(same_face, same_plane);
        }
    }
}

TEST(Setup, PlanesDoNotDependOnTheOrderOfTriangles) {
    // In order, the triangles of a face stand one after the other; shuffled, they do not: two ways to gather
    // a face's range of depth.
    const Mesh mesh = solids::random_solids(7, 60, true, true);
    ASSERT_TRUE(std::is_sorted(mesh.face.begin(), mesh.face.end()));
    std::vector<std::size_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    Mesh shuffled = mesh;
    for (std::size_t i = 0; i < order.size(); ++i) {
        shuffled.triangles[i] = mesh.triangles[order[i]];
        shuffled.component[i] = mesh.component[order[i]];
        shuffled.face[i] = mesh.face[order[i]];
    }
    ASSERT_FALSE(std::is_sorted(shuffled.face.begin(), shuffled.face.end()));

    Camera inside;  // some vertices lie before the near plane
    inside.eye = {0.1, 0.05, 0.2};
    inside.look_at = {0, 0, -1};
    for (const View& view :
         {camera_view(inside, 320, 200), orthographic_light_view(bounds_of(mesh), {0.3, -0.9, 0.1}, 512)}) {
        TriangleSetup runs, scattered;
        setup_triangles(mesh, view, {}, {Isa::ref, 1}, runs);
        setup_triangles(shuffled, view, {}, {best_isa(), 3}, scattered);
        ASSERT_EQ(runs.planes.size(), scattered.planes.size());
        for (std::size_t f = 0; f < runs.planes.size(); ++f) {
            const DepthPlane &p = runs.planes[f], &q = scattered.planes[f];
            ASSERT_TRUE(p.a == q.a && p.b == q.b && p.c == q.c && p.zmin == q.zmin && p.zmax == q.zmax) << f;
        }
    }
}

TEST(Bin, EveryTileListsWhatTouchesItsSamples) {
    const Mesh mesh = solids::random_solids(6, 50, true, false);
    const LightView view = orthographic_light_view(bounds_of(mesh), normalize(Vec3d{1, -2, 0.5}), 300);
    TriangleSetup setup;
    setup_triangles(mesh, view, {}, {}, setup);
    for (const int tile : {16, 32, 64}) {
        TileBins bins;
        bin_records(setup, {0, 0, 300, 300}, tile, {best_isa(), 3}, bins);
        for (int y = 0; y < 300; ++y) {
            for (int x = 0; x < 300; ++x) {
                const auto list = bins.list(x / tile, y / tile);
                ASSERT_TRUE(std::is_sorted(list.begin(), list.end()));
                std::size_t expected = 0, listed = 0;
                for (const RecordBlock& b : setup.blocks) {
                    for (std::size_t i = b.begin; i < b.begin + b.count; ++i)
                        expected += covers(setup.records[i], x, y);
                }
                for (const std::uint32_t i : list)
                    listed += covers(setup.records[i], x, y);
                ASSERT_EQ(listed, expected);
            }
        }
    }
}

}  // namespace
}  // namespace obscura
