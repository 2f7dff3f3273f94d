// The stereo bench: its pictures, its truth, and what a quick run finds and writes. Never times.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "bench/harness/gnuplot.h"
#include "bench/stereo/memory_pass.h"
#include "bench/stereo/peers.h"
#include "bench/stereo/report.h"
#include "bench/stereo/stereo_bench.h"
#include "core/error.h"
#include "stereo/solver/solver.h"
#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

constexpr StereoSize small{96, 54};

std::vector<std::uint32_t> objects_seen(const MiddleView& view) {
    std::vector<std::uint32_t> seen = view.object.pixels;
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    return seen;
}

TEST(StereoScenes, ShowWhatTheyName) {
    // Wall, floor, five spheres, a box, six poles.
    EXPECT_EQ(objects_seen(stereo_bench_view(StereoCase::base, 480, 270)).size(), 14u);
    const MiddleView sky = stereo_bench_view(StereoCase::sky, 480, 270);
    EXPECT_EQ(objects_seen(sky).back(), nothing_seen);
    EXPECT_EQ(stereo_bench_system(StereoCase::sky, sky).valid(0, 0), 0);
    EXPECT_EQ(objects_seen(stereo_bench_view(StereoCase::one_pixel_poles, 480, 270)).size(), 68u);
    EXPECT_EQ(stereo_bench_system(StereoCase::no_matching, 480, 270).sets.size(), 0u);
    EXPECT_EQ(stereo_bench_system(StereoCase::many_sets, 480, 270).sets.size(), 16u);
    EXPECT_EQ(stereo_bench_system(StereoCase::epsilon_1e8, 480, 270).epsilon, 1e-8f);
    const DisparitySystem heavy = stereo_bench_system(StereoCase::anchors_100, 480, 270);
    const auto& weights = heavy.anchor_weight.pixels;
    EXPECT_EQ(*std::max_element(weights.begin(), weights.end()), 100);
}

TEST(StereoScenes, DisparitiesGrowWithTheWidth) {
    for (const StereoCase stereo_case : stereo_cases()) {
        const DisparitySystem one = stereo_bench_system(stereo_case, 240, 135),
                              two = stereo_bench_system(stereo_case, 480, 270);
        const auto range = [](const DisparitySystem& s) {
            const auto [least, largest] = std::minmax_element(s.start.pixels.begin(), s.start.pixels.end());
            return static_cast<double>(*largest - *least);
        };
        EXPECT_NEAR(2 * range(one), range(two), 0.05 * range(two)) << stereo_case_name(stereo_case);
        for (const MatchingSet& set : two.sets) {
            EXPECT_TRUE(std::is_sorted(set.members.begin(), set.members.end(),
                                       [](const MatchedPixel& a, const MatchedPixel& b) {
                                           return std::pair(a.y, a.x) < std::pair(b.y, b.x);
                                       }));
        }
    }
}

// The matrix against the energy's own code: b - A x at a map that is far from the solution.
TEST(StereoMatrix, IsHalfTheEnergysDerivative) {
    for (const StereoCase stereo_case : stereo_cases()) {
        const DisparitySystem system = stereo_bench_system(stereo_case, small.width, small.height);
        const StereoMatrix matrix = stereo_matrix(system);
        const std::vector<double> x(system.start.pixels.begin(), system.start.pixels.end());
        const std::vector<double> written = matrix_residual(matrix, x);
        const Image<double> ours = residual(system, system.start);
        for (std::size_t i = 0; i < written.size(); ++i)
            ASSERT_NEAR(written[i], ours.pixels[i], 1e-9 * (1 + std::abs(written[i])))
                << stereo_case_name(stereo_case) << " pixel " << i;
        for (int row = 0; row < matrix.size; ++row) {
            const auto begin = matrix.columns.begin() + matrix.starts[static_cast<std::size_t>(row)],
                       end = matrix.columns.begin() + matrix.starts[static_cast<std::size_t>(row) + 1];
            ASSERT_EQ(std::adjacent_find(begin, end, std::greater_equal<>()), end);
        }
    }
}

TEST(StereoTruth, SolvesEveryCase) {
    for (const StereoCase stereo_case : stereo_cases()) {
        const StereoTruth truth = stereo_truth(stereo_bench_system(stereo_case, small.width, small.height));
        // In double, or what a map of floats can hold.
        EXPECT_LT(truth.residual, truth.by == cholmod_name ? 1e-9 : 2e-2) << stereo_case_name(stereo_case);
    }
}

TEST(StereoTruth, PeersAgree) {
    const StereoSubject subject = stereo_subject(StereoCase::base, small);
    const DirectSolution ldlt = solve_by_ldlt(subject.matrix);
    if (!ldlt.problem.empty()) GTEST_SKIP() << ldlt.problem;
    EXPECT_LT(map_error(subject.system, ldlt.x.data(), subject.truth.x).max_px, 1e-4);
    for (const auto preconditioner : {CgPreconditioner::diagonal, CgPreconditioner::incomplete_cholesky}) {
        MapError error, first;
        int looks = 0;
        const std::string problem = solve_by_cg(subject.matrix, preconditioner, subject.system.start.pixels,
                                                [&](int iteration, double, const double* x) {
                                                    EXPECT_EQ(iteration, looks++);
                                                    error = map_error(subject.system, x, subject.truth.x);
                                                    if (iteration == 0) first = error;
                                                    return error.within_goal();
                                                });
        EXPECT_EQ(problem, "");
        EXPECT_EQ(first.max_px, map_error(subject.system, subject.system.start, subject.truth.x).max_px);
        EXPECT_TRUE(error.within_goal());
        EXPECT_GT(looks, 10);
    }
}

TEST(StereoTruth, ErrorsCountValidPixelsAlone) {
    DisparitySystem system = unedited_system(DisparityMap(4, 1, 2.0f), Image<std::uint8_t>(4, 1, 1));
    system.valid(3, 0) = 0;
    DisparityMap x(4, 1, 2.0f);
    x(0, 0) = 5;
    x(3, 0) = 100;
    const MapError error = map_error(system, x, {2, 2, 2, 2});
    EXPECT_DOUBLE_EQ(error.max_px, 3);
    EXPECT_DOUBLE_EQ(error.rms_px, std::sqrt(3.0));
    x(1, 0) = NAN;
    EXPECT_FALSE(map_error(system, x, {2, 2, 2, 2}).within_goal());
}

TEST(MemoryPassTest, ReadsThreeNumbersAndWritesOne) {
    for (const bool streaming : {false, true}) {
        MemoryPass pass(100000);
        EXPECT_GE(pass.bytes(), 1600000u);
        EXPECT_LT(pass.bytes(), 1601000u);
        pass.run(streaming, Exec{});
        EXPECT_EQ(pass.result()[0], 1 + 0.75f * (2 - 3));
        EXPECT_EQ(pass.result()[99999], pass.result()[0]);
    }
}

TEST(StereoBench, CountsInPassesOfTheSameSizeAndThreads) {
    StereoResults results;
    results.passes = {{480, 270, 1, 0.5}, {480, 270, 2, 0.25}, {960, 540, 1, 2}};
    StereoRow row;
    row.width = 480;
    row.height = 270;
    row.threads = 2;
    EXPECT_DOUBLE_EQ(in_passes(results, row, 10), 40);
    row.threads = 3;
    EXPECT_EQ(in_passes(results, row, 10), 0);
}

StereoRow goal_row(const char* method, double ms, MapError error) {
    StereoRow row;
    row.width = 480;
    row.height = 270;
    row.method = method;
    row.whole_ms = row.kept_ms = ms;
    row.error = error;
    return row;
}

TEST(StereoGoals, JudgeTheWorst) {
    StereoResults results;
    results.passes = {{480, 270, 1, 0.1}};
    StereoRow ours = goal_row(multigrid_name, 9, {0.04, 0.01});
    ours.iterations = 5;
    ours.curve = {{1, 1, {1, 0.5}}, {2, 2, {0.04, 0.01}}, {3, 3, {0.06, 0.01}}, {4, 4, {0.01, 0.01}}};
    results.rows = {ours, goal_row(cascade_name, 2, {4, 2}), goal_row(cholmod_name, 1000, {0, 0}),
                    goal_row(cg_name, 360, {1, 1})};
    results.rows.back().problem = "stopped";
    CaseRow hard;
    hard.stereo_case = "hard";
    hard.needed = -1;
    hard.iterations = 13;
    results.cases = {hard};
    const std::string goals = stereo_goals_markdown(results);
    const auto has = [&](const char* text) { return goals.find(text) != std::string::npos; };
    // The error leaves the goal again after the second iteration.
    EXPECT_TRUE(has("rms below 0.02 px | <= 8 | 4.00 | 480 x 270 | met")) << goals;
    EXPECT_TRUE(has("stays below the same | <= 12 | inf | hard, 0 x 0 | **not met**")) << goals;
    EXPECT_TRUE(has("whole solve | <= 100 | 90 | 480 x 270 | met")) << goals;
    EXPECT_TRUE(has("time over the cascade's | <= 4 | 4.50 | 480 x 270 | **not met**")) << goals;
    EXPECT_TRUE(has("cascade over ours | >= 100 | 200 | 480 x 270 | met")) << goals;
    EXPECT_TRUE(has("CHOLMOD supernodal | >= 100 | 111 | 480 x 270 | met")) << goals;
    EXPECT_TRUE(has("Eigen CG, diagonal | >= 50 | at least 40 | 480 x 270 | unknown")) << goals;
}

TEST(StereoBench, WritesItsFiles) {
    TemporaryFolder folder;
    BenchOptions options;
    options.quick = true;
    options.scene = "sky";
    options.out = folder.path / "results";
    EXPECT_EQ(bench_stereo(options), 0);
    const auto text_of = [&](const char* name) {
        std::ifstream file(options.out / name);
        std::stringstream text;
        text << file.rdbuf();
        return text.str();
    };
    const std::string report = text_of("stereo.md");
    for (const char* heading : {"## Goals", "## Machine", "### One pass", "## Base case", "## Hard cases",
                                "## Previews", "## Truth", "| sky | 96 x 54"})
        EXPECT_NE(report.find(heading), std::string::npos) << heading;
    const std::string rows = text_of("stereo.csv"), curves = text_of("stereo_curves.csv");
    for (const char* method :
         {multigrid_name, fmg_name, vcycle_name, cascade_name, printed_name, half_name}) {
        EXPECT_NE(rows.find(method), std::string::npos) << method;
        EXPECT_NE(curves.find(method), std::string::npos) << method;
    }
    // Two sizes: six methods with one and two threads, four peers; and a heading.
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 2 * (2 * 6 + 4) + 1);
    EXPECT_FALSE(text_of("stereo_cases.csv").empty());
    if (has_gnuplot()) {
        EXPECT_TRUE(std::filesystem::exists(options.out / "stereo.svg"));
    }
}

}  // namespace
}  // namespace obscura
