// The diffraction bench: what a quick run finds and writes. Never times.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "bench/diffraction/cases.h"
#include "bench/diffraction/diffraction_bench.h"
#include "bench/diffraction/method_timing.h"
#include "bench/diffraction/report.h"
#include "bench/harness/gnuplot.h"
#include "bench/harness/interleave.h"
#include "core/error.h"
#include "tests/core/shared_folder.h"
#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

BenchOptions quick_options(const std::string& aperture) {
    BenchOptions options;
    options.quick = true;
    options.scene = aperture;
    return options;
}

DiffractionBenchPlan quick_plan() {
    return diffraction_bench_plan(true, 1);
}

TEST(Interleaving, TakesTurnsInBothOrders) {
    std::string calls;
    const std::vector<TimedJob> jobs = {{"a", [&] { calls += 'a'; }}, {"b", [&] { calls += 'b'; }}};
    TimingPlan plan;
    plan.rounds = 3;
    plan.turn_ms = 0;  // every job is a long one
    const std::vector<Timing> timings = time_interleaved(jobs, plan);
    EXPECT_EQ(calls, "ababbaab");
    ASSERT_EQ(timings.size(), 2u);
    EXPECT_EQ(timings[0].calls, 3);
    plan.budget_ms = 0;  // two turns each
    calls.clear();
    EXPECT_EQ(time_interleaved(jobs, plan)[1].calls, 2);
    EXPECT_EQ(calls, "ababba");
}

/// What every measured part promises.
void check_rows(const std::vector<DiffractionRow>& rows, double most_error) {
    for (const DiffractionRow& row : rows) {
        const std::string where = row.part + " " + row.aperture + " " + row.method;
        if (!row.problem.empty()) {
            EXPECT_EQ(row.time.calls, 0) << where;
            continue;
        }
        EXPECT_GT(row.time.calls, 0) << where;
        EXPECT_GE(row.time.median_ms, row.time.least_ms) << where;
        EXPECT_GE(row.error, 0) << where;
        if (row.same_function) {
            EXPECT_LE(row.error, most_error) << where;
        }
        EXPECT_EQ(row.method == automatic_name, !row.note.empty()) << where;
    }
}

std::set<std::string> methods_of(const std::vector<DiffractionRow>& rows, int threads) {
    std::set<std::string> methods;
    for (const DiffractionRow& row : rows) {
        if (row.threads == threads && row.problem.empty()) methods.insert(row.method);
    }
    return methods;
}

TEST(DiffractionBench, EveryStrategyOfTheFarFieldAgreesWithTheTruth) {
    const std::vector<DiffractionRow> rows = measure_far(quick_plan(), quick_options("heptagon"));
    check_rows(rows, 1e-6);
    for (const int threads : {1, 2}) {
        const std::set<std::string> methods = methods_of(rows, threads);
        for (const char* method :
             {"direct", "shift", "gemm", "edges", "levels", "runs", "raster_fft", "polygon", "automatic"})
            EXPECT_TRUE(methods.count(method)) << method;
    }
    DiffractionResults results;
    results.rows = rows;
    EXPECT_NE(goals_markdown(results).find("amplitude error, share of F(0, 0) | <= 1e-06"),
              std::string::npos);
}

TEST(DiffractionBench, EveryStrategyOfWindowsAgreesWithTheTruth) {
    const std::vector<DiffractionRow> rows = measure_windows(quick_plan(), quick_options("whirl"));
    check_rows(rows, 1e-6);
    EXPECT_TRUE(methods_of(rows, 1).count("runs"));
    EXPECT_TRUE(methods_of(rows, 2).count("edges"));
}

TEST(DiffractionBench, EveryStrategyOfTheNearFieldAgreesWithTheTruth) {
    DiffractionBenchPlan plan = quick_plan();
    plan.near_sizes = plan.padded_sizes;
    BenchOptions options = quick_options("whirl");
    options.threads = {1};
    const std::vector<DiffractionRow> rows = measure_near(plan, options);
    check_rows(rows, 2e-6);
    for (const char* method : {"direct", "two_pass", "edges", "hybrid", "fft", "automatic"})
        EXPECT_TRUE(methods_of(rows, 1).count(method)) << method;
    for (const ControlRow& row : measure_controls(plan, quick_options("heptagon"))) {
        EXPECT_LE(row.our_error, 2e-6) << row.fresnel_number;
#ifdef OBSCURA_HAS_FFTW
        EXPECT_LE(row.integrated_error, 2e-6) << row.fresnel_number;
        EXPECT_GT(row.sampled_error, 100 * row.our_error) << row.fresnel_number;
#endif
    }
}

TEST(DiffractionBench, MethodsThatWouldTakeTooLongAreLeftOut) {
    DiffractionBenchPlan plan = quick_plan();
    plan.longest_ms = 1e-9;
    BenchOptions options = quick_options("box");
    options.threads = {1};
    for (const DiffractionRow& row : measure_far(plan, options)) {
#ifndef OBSCURA_HAS_FFTW
        if (row.peer) continue;
#endif
        const bool measured = row.peer || (row.size == 64 && row.method != "polygon" && row.one_call);
        if (measured) {
            EXPECT_EQ(row.problem, "") << row.method << ' ' << row.size;
        }
        if (!row.peer && row.size == 128) {
            EXPECT_EQ(row.problem.rfind("left out", 0), 0u) << row.method << ": " << row.problem;
        }
    }
}

TEST(DiffractionBench, CountsWorkAsTheThesisDoes) {
    DiffractionBenchPlan plan = quick_plan();
    plan.sizes = {256, 512, 1024, 2048};
    const int printed[4][4] = {
        {40, 40, 40, 617}, {109, 227, 440, 981}, {176, 389, 730, 1613}, {303, 647, 1358, 2673}};
    const std::vector<QuadRow> quads = measure_quads(plan);
    ASSERT_EQ(quads.size(), 16u);
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_NEAR(static_cast<double>(quads[i].finest) / printed[i / 4][i % 4], 1, 0.07)
            << quads[i].aperture;
        if (i % 4 > 0) {
            EXPECT_EQ(quads[i].aggressive, quads[i - 1].finest);
        }
    }
    plan.sizes = {512};
    const std::vector<CullRow> culling = measure_culling(plan);
    ASSERT_EQ(culling.size(), 1u);
    EXPECT_GT(culling[0].active, 0);
    EXPECT_LT(culling[0].active, 1);
}

TEST(DiffractionBench, CoarserMasksGiveWorsePictures) {
    const std::vector<QualityRow> rows = measure_quality(quick_plan(), quick_options("heptagon"));
    ASSERT_EQ(rows.size(), 4u);
    for (const QualityRow& row : rows) {
        EXPECT_GT(row.ssim, 0.5) << row.field << row.level;
        EXPECT_LT(row.ssim, 1) << row.field << row.level;
        for (const QualityRow& other : rows) {
            if (row.field == other.field && row.level == "finest" && other.level == "aggressive") {
                EXPECT_GT(row.psnr_db, other.psnr_db) << row.field;
            }
        }
    }
}

TEST(DiffractionCases, TelescopesComeFromTheirMasks) {
    const std::filesystem::path data = shared_folder("data");
    SKIP_WITHOUT(data);
    EXPECT_EQ(aperture_names(data).size(), 6u);
    EXPECT_EQ(aperture_names({}).size(), 4u);
    const auto small = diffraction_case("jwst", 256, data), large = diffraction_case("jwst", 2048, data);
    ASSERT_TRUE(small && large);
    EXPECT_EQ(small->mask.mask.width, 128);
    EXPECT_EQ(large->mask.mask.width, 1024);
    EXPECT_NEAR(open_area(small->mask.mask.view()) * 64, open_area(large->mask.mask.view()),
                0.05 * open_area(large->mask.mask.view()));
    EXPECT_FALSE(diffraction_case("jwst", 4096, data));
    EXPECT_FALSE(diffraction_case("jwst", 256, {}));
}

DiffractionRow timed_row(const char* method, double ms, bool one_call, bool peer) {
    DiffractionRow row;
    row.part = far_part;
    row.aperture = "box";
    row.convex = true;
    row.size = 1024;
    row.method = method;
    row.peer = peer;
    row.one_call = one_call;
    row.time = {ms, ms, 1};
    return row;
}

TEST(DiffractionReport, JudgesTheWorstCase) {
    DiffractionResults results;
    results.rows = {timed_row(fftw_image_name, 9, false, true), timed_row(fftw_mask_name, 2, false, true),
                    timed_row(automatic_name, 2, false, false), timed_row(automatic_name, 3, true, false),
                    timed_row("edges", 2, true, false)};
    const std::string goals = goals_markdown(results);
    EXPECT_NE(goals.find("FFTW of the image | >= 4 | 4.50 | box 1024 | met"), std::string::npos) << goals;
    EXPECT_NE(goals.find("FFTW of the mask | >= 1.5 | 1.00 | box 1024 | **not met**"), std::string::npos);
    EXPECT_NE(goals.find("time over the best strategy's | <= 1.2 | 1.50 | box 1024 | **not met**"),
              std::string::npos);
    EXPECT_EQ(goals.find("whirl"), std::string::npos);
    const std::string csv = diffraction_csv(results.rows);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
}

TEST(DiffractionReport, IsWritten) {
    TemporaryFolder folder;
    BenchOptions options = quick_options("circle");
    options.threads = {1};
    options.out = folder.path / "results";
    EXPECT_EQ(bench_diffraction(options), 0);
    std::ifstream file(options.out / "diffraction.md");
    std::stringstream text;
    text << file.rdbuf();
    for (const char* heading : {"## Goals", "## Far field", "## Windows", "## Near field", "(Table 3.1)",
                                "(Table 3.2)", "(Table 3.3)", "Figures 3.8"}) {
        EXPECT_NE(text.str().find(heading), std::string::npos) << heading;
    }
    EXPECT_TRUE(std::filesystem::exists(options.out / "diffraction.csv"));
    if (!has_gnuplot()) return;
    for (const char* chart : {"time", "error", "window", "near"})
        EXPECT_TRUE(std::filesystem::exists(options.out / (std::string("diffraction_") + chart + ".svg")))
            << chart;
    options.scene = "pentagon";
    EXPECT_THROW(bench_diffraction(options), UsageError);
}

}  // namespace
}  // namespace obscura
