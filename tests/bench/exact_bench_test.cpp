// The bench of exact shadows: both methods answer for the same samples, and a small run writes its tables.

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "bench/harness/recipes.h"
#include "bench/shadows/exact_session.h"
#include "bench/shadows/frame_samples.h"
#include "bench/shadows/scenes.h"
#include "bench/shadows/visible_points.h"
#include "raster/exact/exact_shadow.h"
#include "raster/view.h"

namespace obscura {
namespace {

Scene small_city(int width, int height, int samples) {
    Scene scene = stage_shadows(
        {"boxes", "", {0.55, -0.62, -0.38}, {-0.9, 1.1, 1.6}, {0, 0.1, 0}, [] { return box_city(4, 4); }},
        {width, height});
    scene.lights[0].shadow.method = ShadowMethod::exact;
    scene.render.samples = samples;
    return scene;
}

TEST(FrameSamples, AreThePointsThatPixelsSee) {
    const Scene scene = small_city(192, 108, 1);
    const FrameSamples samples = frame_samples(scene, Exec{});
    const VisiblePoints points = visible_points(scene, Exec{});
    EXPECT_EQ(samples.covered, points.covered);
    ASSERT_EQ(samples.tiles, 6u);
    std::size_t compared = 0;
    for (std::size_t b = 0; b < points.blocks.size(); ++b) {
        const SurfaceBlock& block = points.blocks[b];
        for (int at = 0; at < block_samples; ++at) {
            const std::size_t pixel = points.pixel(b, at);
            const auto x = static_cast<int>(pixel % 192), y = static_cast<int>(pixel / 192);
            const ExactPoints tile =
                samples.points(static_cast<std::size_t>(y / frame_tile_side * 3 + x / frame_tile_side));
            const int i = exact_point_index(0, 1, x % frame_tile_side, y % frame_tile_side);
            ASSERT_EQ((tile.covered[i / 16] >> (i % 16) & 1u) != 0, is_covered(block, at));
            if (!is_covered(block, at)) continue;
            ++compared;
            // A float relative to the eye, and then on the plane of its face.
            const double float_x = points.eye.x + static_cast<double>(block.px[at]);
            ASSERT_NEAR(tile.px[i], float_x, 1e-5 * (1 + std::fabs(static_cast<double>(block.px[at]))));
            const Plane& plane = scene.mesh.faces[tile.face[i]];
            ASSERT_NEAR(dot(plane.n, Vec3d{tile.px[i], tile.py[i], tile.pz[i]}) + plane.d, 0, 1e-12);
            ASSERT_EQ(tile.triangle[i], block.triangle[at]);
            ASSERT_EQ(tile.gz[i], block.gz[at]);
            ASSERT_EQ(tile.face[i], scene.mesh.face[block.triangle[at]]);
        }
    }
    EXPECT_GT(compared, 5000u);
}

TEST(FrameSamples, EndWithThePicture) {
    for (const int per_pixel : {1, 4}) {
        // Looking at the ground alone: every pixel sees it.
        Scene scene = small_city(100, 70, per_pixel);
        scene.camera.eye = scene.camera.look_at + Vec3d{1e-3, 2, 1e-3};
        scene.camera.vfov_deg = 10;
        const FrameSamples samples = frame_samples(scene, Exec{});
        EXPECT_EQ(samples.covered, static_cast<std::size_t>(100 * 70 * per_pixel));
    }
}

TEST(ExactSessions, FindingsSurviveTheirFloats) {
    float floats[findings_floats];
    const ExactFindings given{1, (std::int64_t{1} << 24) + 1, 123456789012, 0};
    write_findings(given, floats);
    const ExactFindings back = read_findings(floats);
    EXPECT_EQ(back.asked, given.asked);
    EXPECT_EQ(back.lit, given.lit);
    EXPECT_EQ(back.groups, given.groups);
    EXPECT_EQ(back.triangles, given.triangles);
}

ExactFindings findings_of(const Session& session) {
    for (const Job& job : session.jobs)
        job.run();
    float floats[findings_floats];
    session.jobs[1].deliver(floats);
    return read_findings(floats);
}

#ifdef OBSCURA_HAS_EMBREE
TEST(ExactSessions, BothMethodsAnswerForTheSameSamples) {
    for (const LightKind kind : {LightKind::directional, LightKind::point, LightKind::spot}) {
        for (const int per_pixel : {1, 4}) {
            Scene scene = small_city(192, 108, per_pixel);
            Light& light = scene.lights[0].light;
            light.kind = kind;
            const Bounds bounds = bounds_of(scene.mesh);
            light.position = (bounds.low + bounds.high) * 0.5;
            light.position.y = bounds.high.y * 1.5;
            light.direction = kind == LightKind::spot ? Vec3d{0, -1, 0} : light.direction;
            light.outer_cone_deg = 50;
            light.range_m = 1000;
            const FrameSamples samples = frame_samples(scene, Exec{});
            const ExactFindings ours = findings_of(open_exact(scene, samples, Exec{}));
            const ExactFindings rays = findings_of(open_exact_rays(scene, samples, Exec{}));
            EXPECT_GT(ours.asked, 3000 * per_pixel) << static_cast<int>(kind);
            EXPECT_EQ(ours.asked, rays.asked);
            EXPECT_GT(ours.groups, 0);
            EXPECT_GT(ours.triangles, 0);
            // Some are dark; rays start a little off the surface, and differ there.
            EXPECT_LT(ours.lit, ours.asked * 99 / 100);
            EXPECT_GT(ours.lit, ours.asked / 10);
            EXPECT_LE(std::abs(ours.lit - rays.lit), ours.asked / 500) << static_cast<int>(kind);
        }
    }
}
#endif

/// Columns of a CSV file by their names, row by row.
std::vector<std::map<std::string, std::string>> read_csv(const std::filesystem::path& file) {
    std::ifstream in(file);
    const auto cells = [](const std::string& line) {
        std::vector<std::string> list(1);
        for (const char c : line)
            c == ',' ? list.emplace_back() : list.back() += c;
        return list;
    };
    std::string line;
    std::getline(in, line);
    const std::vector<std::string> names = cells(line);
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(in, line)) {
        const std::vector<std::string> values = cells(line);
        EXPECT_EQ(values.size(), names.size()) << line;
        auto& row = rows.emplace_back();
        for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i)
            row[names[i]] = values[i];
    }
    return rows;
}

TEST(SoftBench, QuickRunAgreesWithRays) {
#if defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "workers are forked, which the thread sanitizer does not follow";
#endif
    const std::filesystem::path out =
        std::filesystem::temp_directory_path() / ("obscura_soft_bench_test_" + std::to_string(getpid()));
    const std::string command = std::string("'") + OBSCURA_BINARY +
                                "' bench shadows --part soft --quick --runs 1 -o '" + out.string() +
                                "' > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::set<std::string> lights;
    for (auto& row : read_csv(out / "shadows_soft.csv")) {
        lights.insert(row["light"]);
        EXPECT_GT(std::stod(row["lookup_median_ms"]), 0);
#ifdef OBSCURA_HAS_EMBREE
        EXPECT_GT(std::stoll(row["pairs"]), 4 * std::stoll(row["covered"]) / 2);
        // Edges pass by a few of 8192 pixels.
        EXPECT_LE(std::stoll(row["apart"]), std::stoll(row["pairs"]) / 1000) << row["light"];
#endif
    }
    EXPECT_EQ(lights.size(), 3u);
    std::filesystem::remove_all(out);
}

TEST(ExactBench, QuickRunWritesTables) {
#if defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "workers are forked, which the thread sanitizer does not follow";
#endif
    const std::filesystem::path out =
        std::filesystem::temp_directory_path() / ("obscura_exact_bench_test_" + std::to_string(getpid()));
    const std::string command = std::string("'") + OBSCURA_BINARY +
                                "' bench shadows --part exact --quick --runs 1 -o '" + out.string() +
                                "' > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::map<std::string, int> series;
    for (auto& row : read_csv(out / "shadows_exact.csv")) {
        ++series[row["series"]];
        EXPECT_GT(std::stoll(row["samples"]), 0);
        EXPECT_LE(std::stoll(row["samples"]), std::stoll(row["covered"]));
        EXPECT_GT(std::stod(row["order_median_ms"]) + std::stod(row["lookup_median_ms"]), 0);
#ifdef OBSCURA_HAS_EMBREE
        EXPECT_GT(std::stod(row["ratio"]), 0);
        EXPECT_NEAR(std::stod(row["exact_lit_percent"]), std::stod(row["embree_lit_percent"]), 1.0);
#endif
    }
    // One and four samples, one and two threads.
    EXPECT_EQ(series["scenes"], 4);
    EXPECT_EQ(series["samples"], 8);
    EXPECT_EQ(series["triangles"], 4);
#ifdef OBSCURA_HAS_EMBREE
    std::set<std::string> methods;
    std::map<std::string, double> least;
    for (auto& row : read_csv(out / "shadows_error_time.csv")) {
        const double wrong = std::stod(row["wrong_percent"]);
        methods.insert(row["method"]);
        const auto known = least.find(row["method"]);
        if (known == least.end() || wrong < known->second) least[row["method"]] = wrong;
        EXPECT_GT(std::stod(row["build_s"]) + std::stod(row["lookup_s"]), 0);
    }
    EXPECT_EQ(methods, (std::set<std::string>{"dense", "compressed", "exact", "Embree"}));
    EXPECT_LT(least["exact"], 0.1 * least["dense"]);
#endif
    EXPECT_TRUE(std::filesystem::exists(out / "shadows_exact.md"));
    std::filesystem::remove_all(out);
}

}  // namespace
}  // namespace obscura
