// The truth of shadows by exact rays, against every triangle in double; what a dense map gets wrong.

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "app/frame/scene_light.h"
#include "bench/harness/recipes.h"
#include "bench/shadows/scenes.h"
#include "bench/shadows/visible_points.h"
#include "filters/shadow_lookup.h"
#include "raster/shadow_map.h"
#include "scenes/build.h"
#include "scenes/shapes.h"
#ifdef OBSCURA_HAS_EMBREE
#include "app/frame/render_frame.h"
#include "app/frame/shadows.h"
#include "bench/shadows/exact_rays.h"
#include "bench/shadows/exact_wrong.h"
#include "bench/shadows/map_points.h"
#include "bench/shadows/methods.h"
#include "bench/shadows/wrong_pixels.h"
#include "bench/shadows/wrong_sweep.h"

namespace obscura {
namespace {

constexpr PictureSize small_picture{192, 108};

/// Towers, a torus that shades itself, and a box that rests on the slab's rim.
Mesh small_town() {
    Mesh mesh = box({-10, -1, -10}, {10, 0, 10});
    add_part(mesh, box({-6, 0, -5}, {-2, 3, -1}), Affine{});
    add_part(mesh, box({1, 0, 2}, {3, 6, 4}), Affine{});
    add_part(mesh, box({6, 0, -7}, {10, 3, -3}), Affine{});
    add_part(mesh, torus(2.5, 0.8, 40, 14), translation(-4, 2.5, 5) * rotation_x(40));
    mesh.uvs.clear();
    return mesh;
}

Scene small_scene() {
    return stage_shadows({"small", "", {0.55, -0.62, -0.38}, {-0.9, 1.1, 1.6}, {0, 0.1, 0}, small_town},
                         small_picture);
}

/// Whether segment p + t d, t > 1e-9, meets a triangle off the face it starts on (Moeller and Trumbore).
bool meets_any(const Mesh& mesh, Vec3d p, std::uint32_t face, Vec3d d) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.face[i] == face) continue;
        const auto corner = [&](int k) { return to_double(mesh.positions[mesh.triangles[i].v[k]]); };
        const Vec3d a = corner(0), e1 = corner(1) - a, e2 = corner(2) - a;
        const Vec3d h = cross(d, e2);
        const double det = dot(e1, h);
        if (det == 0) continue;
        const double u = dot(p - a, h) / det, v = dot(d, cross(p - a, e1)) / det;
        const double t = dot(e2, cross(p - a, e1)) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && t > 1e-9) return true;
    }
    return false;
}

TEST(ShadowTruth, EqualsEveryTriangleInDouble) {
    const Scene scene = small_scene();
    const VisiblePoints points = visible_points(scene, Exec{});
    const ExactRays rays(scene.mesh);
    const TrueShadows truth = true_shadows_of(scene, points, rays, Exec{});
    std::size_t dark = 0, differ = 0, facing = 0;
    for (std::size_t b = 0; b < points.blocks.size(); ++b) {
        const SurfaceBlock& s = points.blocks[b];
        for (int at = 0; at < block_samples; at += 3) {
            const Truth seen = truth.truth[points.pixel(b, at)];
            EXPECT_EQ(seen == Truth::nothing, !is_covered(s, at));
            if (seen != Truth::lit && seen != Truth::dark) continue;
            const std::uint32_t face = scene.mesh.face[s.triangle[at]];
            const Vec3d p =
                on_plane(scene.mesh.faces[face], points.eye + to_double(Vec3f{s.px[at], s.py[at], s.pz[at]}));
            const bool hit = meets_any(scene.mesh, p, face, truth.to_light);
            ++facing;
            dark += hit ? 1 : 0;
            differ += hit == (seen == Truth::dark) ? 0 : 1;
        }
    }
    EXPECT_GT(facing, 1000u);
    EXPECT_GT(dark, 200u);
    EXPECT_LE(differ, 1u);  // a ray through an edge, within the floats of Embree
}

TEST(ShadowTruth, DenseMapsErrByTheirResolutionAlone) {
    const Scene scene = stage_shadows(
        {"boxes", "", {0.55, -0.62, -0.38}, {-0.9, 1.1, 1.6}, {0, 0.1, 0}, [] { return box_city(4, 4); }},
        small_picture);
    const VisiblePoints points = visible_points(scene, Exec{});
    const ExactRays rays(scene.mesh);
    const TrueShadows truth = true_shadows_of(scene, points, rays, Exec{});
    double last = 1;
    for (const int size : {64, 256, 1024}) {
        const SceneLight light = shadow_light(scene, size, 1);
        ShadowMap map;
        RasterScratch scratch;
        ASSERT_TRUE(build_shadow_map(scene.mesh, light, bounds_of(scene.mesh), Exec{}, scratch, map));
        const PcfLight pcf = pcf_light(light, map, scene.camera.eye);
        const auto lookup = [&](const SurfaceBlock& s, float* v) { ref::pcf_block(s, pcf, v); };
        const WrongPixels wrong =
            wrong_pixels(truth, shown_shadows(points, lookup, Exec{}), map.views[0], Exec{});
        std::printf("%4d: %zu of %zu wrong, outline %zu, inside %zu\n", size, wrong.wrong, wrong.covered,
                    wrong.by_kind[2], wrong.by_kind[3]);
        EXPECT_GT(wrong.facing, 5000u);
        EXPECT_LT(wrong.fraction(), 0.5 * last);
        EXPECT_EQ(wrong.by_kind[static_cast<std::size_t>(Wrong::open)], 0u);
        EXPECT_LE(wrong.by_kind[static_cast<std::size_t>(Wrong::interval)], 1 + wrong.wrong / 50);
        last = wrong.fraction();
    }
}

/// Dense and compressed maps may differ only where the depth that was tested lies inside a solid.
TEST(ShadowTruth, CompressedDiffersFromDenseOnlyInsideSolids) {
    const Scene scene = small_scene();
    const VisiblePoints points = visible_points(scene, Exec{});
    const int size = 256;
    const BuiltShadow dense = build_dense(scene, size, Exec{});
    const BuiltShadow compressed = build_compressed(scene, size, Exec{});
    const Image<DepthInterval> intervals = interval_map(scene.mesh, dense.view, {}, Exec{});
    const auto shown = shown_shadows(points, dense.lookups(Isa::ref)[0].block, Exec{});
    const auto shown_by_tree = shown_shadows(points, compressed.lookups(Isa::ref)[0].block, Exec{});
    std::size_t differ = 0, lit = 0;
    for (std::size_t b = 0; b < points.blocks.size(); ++b) {
        for (int at = 0; at < block_samples; ++at) {
            const std::size_t pixel = points.pixel(b, at);
            lit += shown_by_tree[pixel];
            if (shown[pixel] == shown_by_tree[pixel]) continue;
            ++differ;
            const TestedTexel t = tested_texel(points.blocks[b], dense.light, at);
            ASSERT_TRUE(t.looked_up);
            EXPECT_LT(intervals(t.x, t.y).entry, t.depth);
            EXPECT_LE(t.depth, intervals(t.x, t.y).exit);
        }
    }
    std::printf("%zu of %zu pixels differ, %zu lit\n", differ, points.covered, lit);
    EXPECT_GT(lit, 3000u);
    EXPECT_GT(differ, 0u);  // else nothing was tested: make the map coarser
}

TEST(ShadowTruth, BarePointsAnswerAsBlocksDo) {
    const Scene scene = small_scene();
    const VisiblePoints points = visible_points(scene, Exec{});
    for (const bool tree : {false, true}) {
        const BuiltShadow built =
            tree ? build_compressed(scene, 512, Exec{}) : build_dense(scene, 512, Exec{});
        const MapPointList list = map_points(points, built.light);
        for (const Isa isa : supported_isas()) {
            const auto shown = shown_shadows(points, built.lookups(isa)[0].block, Exec{});
            for (const PointLookup& lookup : built.point_lookups(isa)) {
                std::vector<std::uint16_t> lit((list.x.size() + 15) / 16);
                lookup.look(list.points(0, list.x.size()), lit.data());
                std::size_t wrong = 0;
                for (std::size_t i = 0; i < list.x.size(); ++i)
                    wrong += (lit[i / 16] >> (i % 16) & 1u) == shown[list.pixel[i]] ? 0 : 1;
                EXPECT_EQ(wrong, 0u) << lookup.name << ' ' << isa_name(isa) << ' ' << tree;
            }
        }
    }
}

/// A small scene whose light is exact, and what its method shows.
struct ExactStage {
    SweepStage stage{{"small", "", {0.55, -0.62, -0.38}, {-0.9, 1.1, 1.6}, {0, 0.1, 0}, small_town},
                     small_picture};
    FrameCache cache;
    TileScene tiles;
    ExactPicture picture;
    std::vector<std::uint8_t> shown;

    ExactStage() {
        Scene& scene = stage.scene;
        scene.lights[0].shadow.method = ShadowMethod::exact;
        FrameStats stats;
        prepare_scene(scene, stage.exec, cache, stats);
        tiles = prepare_tiles(scene, stage.exec, cache);
        EXPECT_TRUE(prepare_shadows(scene, 0, stage.exec, cache, tiles, stats));
        picture = {&stage.truth, &*tiles.lights.at(0).exact, tiles.rays};
        const BlockLookup lookup = exact_lookup(scene.mesh, *picture.light, stage.exec.isa);
        shown = shown_shadows(stage.points, lookup, stage.exec);
    }
    WrongPixels wrong(std::vector<std::uint8_t>* kinds = nullptr) const {
        const auto kind_of = [&](std::size_t b, int at, Truth t) { return kind_of_exact(picture, b, at, t); };
        return count_wrong(stage.truth, shown, kind_of, stage.exec, kinds);
    }
};

TEST(ShadowTruth, ExactShadowsAreWrongAtEdgesAlone) {
    const ExactStage exact;
    const WrongPixels wrong = exact.wrong();
    std::printf("%zu of %zu wrong (%s)\n", wrong.wrong, wrong.covered, kinds_text(wrong).c_str());
    EXPECT_GT(wrong.facing, 5000u);
    EXPECT_LE(wrong.wrong, 2u);
    EXPECT_EQ(wrong.by_kind[static_cast<std::size_t>(Wrong::unexplained)], 0u);
}

/// Turned over, only pixels beside a shadow's outline may be excused.
TEST(ShadowTruth, WhatIsWrongFarFromEdgesIsNotExplained) {
    ExactStage exact;
    const std::size_t wrong_before = exact.wrong().wrong;
    for (std::uint8_t& lit : exact.shown)
        lit = lit != 0 ? 0 : 1;
    std::vector<std::uint8_t> kinds;
    const WrongPixels wrong = exact.wrong(&kinds);
    const auto count = [&](Wrong kind) { return wrong.by_kind[static_cast<std::size_t>(kind)]; };
    std::printf("%zu of %zu (%s)\n", wrong.wrong, wrong.facing, kinds_text(wrong).c_str());
    EXPECT_EQ(wrong.wrong, wrong.facing - wrong_before);
    EXPECT_GT(count(Wrong::unexplained), wrong.facing * 9 / 10);
    EXPECT_GT(count(Wrong::edge), 0u);
    EXPECT_EQ(count(Wrong::outline) + count(Wrong::interval) + count(Wrong::grazing) + count(Wrong::open),
              0u);
    EXPECT_EQ(std::count(kinds.begin(), kinds.end(), 1 + static_cast<int>(Wrong::unexplained)),
              static_cast<std::ptrdiff_t>(count(Wrong::unexplained)));
}

TEST(ShadowTruth, RaysLeaveOutWhatIsBesideTheirStart) {
    const ExactStage exact;
    const Mesh& mesh = exact.stage.scene.mesh;
    const VisiblePoints& points = exact.stage.points;
    std::size_t dark = 0, left_out = 0;
    for (std::size_t b = 0; b < points.blocks.size(); ++b) {
        const SurfaceBlock& s = points.blocks[b];
        for (int at = 0; at < block_samples; at += 5) {
            if (exact.stage.truth.truth[points.pixel(b, at)] != Truth::dark) continue;
            const std::uint32_t face = mesh.face[s.triangle[at]];
            const Vec3d p =
                on_plane(mesh.faces[face], points.eye + to_double(Vec3f{s.px[at], s.py[at], s.pz[at]}));
            ++dark;
            EXPECT_TRUE(exact.stage.rays.occluded_beyond(p, face, exact.stage.truth.to_light, 0));
            // Nothing of the scene is as large as that.
            left_out += exact.stage.rays.occluded_beyond(p, face, exact.stage.truth.to_light, 100) ? 0 : 1;
        }
    }
    EXPECT_GT(dark, 100u);
    EXPECT_EQ(left_out, dark);
}

TEST(ShadowBench, QuickRunWritesTablesAndCharts) {
#if defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "workers are forked, which the thread sanitizer does not follow";
#endif
    const std::filesystem::path out =
        std::filesystem::temp_directory_path() / ("obscura_shadow_bench_test_" + std::to_string(getpid()));
    // In a process of its own: workers must be forked before any thread is started.
    const std::string command = std::string("'") + OBSCURA_BINARY + "' bench shadows --quick --runs 1 -o '" +
                                out.string() + "' > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    for (const char* name : {"shadows.md", "shadows_accuracy.csv", "shadows_times.csv", "shadows_trees.csv",
                             "shadows_directions.csv", "shadows_city.png"}) {
        EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
    }
    std::ifstream csv(out / "shadows_times.csv");
    std::string line;
    std::getline(csv, line);
    const auto columns = std::count(line.begin(), line.end(), ',');
    std::map<std::string, int> rows;
    int hierarchical = 0;
    while (std::getline(csv, line)) {
        // The names of jobs may hold commas, in quotes.
        EXPECT_GE(std::count(line.begin(), line.end(), ','), columns) << line;
        hierarchical += line.find("hierarchical") != std::string::npos ? 1 : 0;
        const std::size_t begin = line.find(',', line.find(',') + 1) + 1;
        ++rows[line.substr(begin, line.find(',', begin) - begin)];
    }
    for (const char* method : {"dense", "compressed", "Embree"})
        EXPECT_GT(rows[method], 0) << method;
    EXPECT_EQ(hierarchical, 8);  // sides 3 and 5, two sizes, one and two threads
    // Wrong pixels: three suns; exact, and trees of four sizes.
    std::ifstream wrong(out / "shadows_wrong.csv");
    std::map<std::string, int> of_sun;
    std::getline(wrong, line);
    EXPECT_NE(line.find(",off,edge,beside,unexplained,problem"), std::string::npos);
    while (std::getline(wrong, line)) {
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 21) << line;
        const std::size_t sun = line.find(',', line.find(',') + 1) + 1;
        ++of_sun[line.substr(sun, line.find(',', line.find(',', sun) + 1) - sun)];
    }
    for (const char* sun : {"40", "8", "1"}) {
        EXPECT_EQ(of_sun[std::string(sun) + ",exact"], 1) << sun;
        EXPECT_EQ(of_sun[std::string(sun) + ",compressed"], 5) << sun;
    }
    // The summary: one line per method and timed size, none without its error but the largest tree's.
    std::ifstream report(out / "shadows.md");
    int lines = 0, unknown = 0;
    while (std::getline(report, line) && line != "## Summary") {
    }
    while (std::getline(report, line) && line.rfind("## ", 0) != 0) {
        lines += line.rfind("| city |", 0) == 0 ? 1 : 0;
        unknown += line.rfind("| city | compressed 4k | - |", 0) == 0 ? 1 : 0;
    }
    EXPECT_EQ(lines, 5);
    EXPECT_EQ(unknown, 1);
    std::filesystem::remove_all(out);
}

}  // namespace
}  // namespace obscura
#else
TEST(ShadowTruth, NeedsEmbree) {
    GTEST_SKIP() << "this build has no Embree to trace exact rays with";
}
#endif
