// The bench's peers against a brute-force oracle on a scene small enough for one.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "bench/raster/charts.h"
#include "bench/raster/raster_bench.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

/// Four boxes that float above a slab: disjoint convex solids, so every exit is a second layer.
Mesh boxes_over_slab() {
    Mesh mesh = box({-10, -1, -10}, {10, 0, 10});
    add_part(mesh, box({-6, 0.5, -5}, {-2, 3, -1}), Affine{});
    add_part(mesh, box({1, 0.25, 2}, {3, 6, 4}), Affine{});
    add_part(mesh, box({3, 2, -7}, {7, 3, -3}), Affine{});
    add_part(mesh, box({-7, 0.5, 4}, {-5, 4, 8}), Affine{});
    return mesh;
}

BenchScene small_scene() {
    return stage_scene("boxes", boxes_over_slab(), BenchSize{128, 160, 90});
}

/// Sorted depths of every triangle over the centre of texel (x, y), by barycentric coordinates in double.
std::vector<double> depths_at(const BenchScene& bench, int x, int y) {
    std::vector<double> depths;
    for (const Triangle& triangle : bench.scene.mesh.triangles) {
        Vec4d p[3];
        for (int i = 0; i < 3; ++i) {
            const Vec3d w = to_double(bench.scene.mesh.positions[triangle.v[i]]);
            p[i] = bench.light.to_map * Vec4d{w.x, w.y, w.z, 1};
        }
        const auto edge = [&](const Vec4d& a, const Vec4d& b) {
            return (b.x - a.x) * (y + 0.5 - a.y) - (b.y - a.y) * (x + 0.5 - a.x);
        };
        const double e0 = edge(p[1], p[2]), e1 = edge(p[2], p[0]), e2 = edge(p[0], p[1]);
        const double area = e0 + e1 + e2;
        if (area == 0 || e0 * area < 0 || e1 * area < 0 || e2 * area < 0) continue;
        depths.push_back((e0 * p[0].z + e1 * p[1].z + e2 * p[2].z) / area);
    }
    std::sort(depths.begin(), depths.end());
    return depths;
}

/// First and second layer by brute force, as a contestant.
Contestant oracle() {
    const auto open = [](const BenchScene& bench, const Exec&) {
        const auto maps = std::make_shared<std::vector<float>>();
        const auto run = [&bench, maps] {
            const std::size_t texels = result_size(Workload::depth, bench);
            maps->assign(2 * texels, 1.0f);
            for (std::size_t i = 0; i < texels; ++i) {
                const auto width = static_cast<std::size_t>(bench.light.width);
                const auto depths =
                    depths_at(bench, static_cast<int>(i % width), static_cast<int>(i / width));
                if (depths.empty()) continue;
                (*maps)[i] = static_cast<float>(depths[0]);
                const auto second = std::find_if(depths.begin(), depths.end(),
                                                 [&](double d) { return d > depths[0] + 1e-7; });
                if (second != depths.end()) (*maps)[texels + i] = static_cast<float>(*second);
            }
        };
        const auto deliver = [maps](std::size_t count, float* result) {
            std::copy_n(maps->begin(), count, result);
        };
        const std::size_t texels = result_size(Workload::depth, bench);
        Session session;
        session.version = "brute force";
        session.jobs = {
            {Workload::depth, "all triangles", true, run, [=](float* r) { deliver(texels, r); }},
            {Workload::dual_depth, "all triangles", true, run, [=](float* r) { deliver(2 * texels, r); }},
        };
        return session;
    };
    return {"oracle", "", open};
}

std::vector<BenchRow> measure_against_oracle(const BenchOptions& options) {
    std::vector<Contestant> contestants = {oracle()};
    for (const Contestant& contestant : all_contestants())
        contestants.push_back(contestant);
    return measure_scene(contestants, small_scene(), options);
}

std::string title(const BenchRow& row) {
    return std::string(workload_name(row.workload)) + ", " + row.contestant + ", " + row.method + ", " +
           std::to_string(row.threads) + " threads";
}

TEST(RasterBench, PeersSeeWhatTheOracleSees) {
#if defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "workers are forked, which the thread sanitizer does not follow";
#endif
    BenchOptions options;
    options.runs = 1;
    const std::vector<BenchRow> rows = measure_against_oracle(options);
    const auto of_oracle = [&](Workload workload) {
        return *std::find_if(rows.begin(), rows.end(), [&](const BenchRow& row) {
            return row.contestant == "oracle" && row.workload == workload;
        });
    };
    int compared = 0;
    for (const BenchRow& row : rows) {
        if (row.problem.rfind("absent", 0) == 0) {
            std::printf("%s: %s\n", row.contestant.c_str(), row.problem.c_str());
            continue;
        }
        EXPECT_EQ(row.problem, "") << title(row);
        if (!row.agreement || is_frame(row.workload)) continue;
        ++compared;
        const Agreement expected = *of_oracle(row.workload).agreement;
        EXPECT_NEAR(row.agreement->covered, expected.covered, 0.002) << title(row);
        EXPECT_NEAR(row.agreement->mean_first, expected.mean_first, 0.002) << title(row);
        EXPECT_NEAR(row.agreement->mean_second, expected.mean_second, 0.004) << title(row);
        EXPECT_LT(row.agreement->wrong_inside, 0.001) << title(row);
    }
    EXPECT_GE(compared, 4);
}

TEST(RasterBench, PeersPaintTheSameFrame) {
#if defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "workers are forked, which the thread sanitizer does not follow";
#endif
    BenchOptions options;
    options.runs = 1;
    options.threads = {2};
    std::vector<BenchRow> frames;
    for (const BenchRow& row : measure_against_oracle(options)) {
        if (is_frame(row.workload) && row.agreement) frames.push_back(row);
    }
    const BenchRow* peer = nullptr;
    for (const BenchRow& row : frames) {
        EXPECT_GT(row.agreement->covered, 0.3) << title(row);
        EXPECT_NEAR(row.agreement->covered, frames[0].agreement->covered, 0.005) << title(row);
        EXPECT_GT(row.agreement->mean_first, 0.1) << title(row);
        if (row.contestant == "Obscura") continue;  // shades by another model
        if (peer == nullptr) peer = &row;
        EXPECT_NEAR(row.agreement->mean_first, peer->agreement->mean_first, 0.01) << title(row);
    }
}

/// Splits one line of CSV.
std::vector<std::string> columns_of(const std::string& line) {
    std::vector<std::string> columns(1);
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') quoted = !quoted;
        if (c == ',' && !quoted) {
            columns.emplace_back();
        } else {
            columns.back() += c;
        }
    }
    return columns;
}

TEST(RasterBench, QuickRunWritesTablesAndCharts) {
#if defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "workers are forked, which the thread sanitizer does not follow";
#endif
    const std::filesystem::path out =
        std::filesystem::temp_directory_path() / ("obscura_bench_test_" + std::to_string(getpid()));
    BenchOptions options;
    options.out = out;
    options.quick = true;
    options.runs = 2;
    std::string said;
    options.say = [&said](const std::string& line) { said += line + '\n'; };
    EXPECT_EQ(bench_raster(options), 0);

    std::ifstream csv(out / "raster.csv");
    std::string line;
    std::getline(csv, line);
    const std::vector<std::string> names = columns_of(line);
    for (const char* name :
         {"scene", "triangles", "workload", "contestant", "method", "threads", "median_ms", "min_ms",
          "max_ms", "ratio_to_obscura", "prepare_ms", "covered", "version", "problem"}) {
        EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
    }
    std::set<std::string> contestants;
    while (std::getline(csv, line)) {
        const std::vector<std::string> values = columns_of(line);
        ASSERT_EQ(values.size(), names.size()) << line;
        contestants.insert(values[5]);
        if (!values.back().empty()) continue;
        EXPECT_GT(std::stod(values[10]), 0.0) << line;
        EXPECT_LE(std::stod(values[11]), std::stod(values[10])) << line;
        EXPECT_GE(std::stod(values[12]), std::stod(values[10])) << line;
    }
    EXPECT_EQ(contestants, (std::set<std::string>{"Obscura", "llvmpipe", "Embree", "memory limit"}));

    const bool charted = said.find("gnuplot is not installed") == std::string::npos;
    EXPECT_EQ(std::filesystem::exists(out / "raster_depth.svg"), charted);
    EXPECT_TRUE(std::filesystem::exists(out / "raster.md"));
    std::filesystem::remove_all(out);
}

TEST(RasterBench, ChartNamesEveryMethodAndItsRatio) {
    BenchRow ours;
    ours.scene = "town";
    ours.contestant = "Obscura";
    ours.method = "exact";
    ours.runs_ms = {10, 11, 12};
    BenchRow peer = ours;
    peer.contestant = "Embree";
    peer.method = "packets";
    peer.runs_ms = {33, 30, 40};
    BenchOptions options;
    options.threads = {1};
    const std::string script = chart_script({ours, peer}, Workload::depth, options);
    EXPECT_NE(script.find("Obscura: exact"), std::string::npos);
    EXPECT_NE(script.find("Embree: packets"), std::string::npos);
    EXPECT_NE(script.find("'3.0x'"), std::string::npos);
    EXPECT_EQ(chart_script({ours, peer}, Workload::frame, options), "");
}

}  // namespace
}  // namespace obscura
