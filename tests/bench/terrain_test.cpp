// The terrain bench: what a quick run finds and writes. Never times.

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/terrain/terrain_bench.h"
#include "core/error.h"

namespace obscura {
namespace {

BenchOptions quick_options() {
    BenchOptions options;
    options.quick = true;
    options.runs = 1;
    return options;
}

TEST(TerrainBench, WaysAgreeAndOurBitsAreFewer) {
    const std::vector<TerrainSubject> subjects = terrain_subjects(quick_options());
    ASSERT_EQ(subjects.size(), 1u);
    const TerrainRow row = measure_terrain(subjects[0], quick_options());
    EXPECT_EQ(row.suns, 12);
    EXPECT_EQ(row.sweep.samples, 12 * 257 * 257);
    EXPECT_GT(row.far_dark, 0.01);
    EXPECT_LT(row.far_dark, row.dark);
    EXPECT_EQ(row.march.differ, 0);
    EXPECT_GT(row.march.samples, 10'000);
    if (row.embree) {
        // Floats: 1e-5 of the samples on real ground, here some more of fewer.
        EXPECT_LT(static_cast<double>(row.embree->differ), 1e-4 * static_cast<double>(row.embree->samples));
    }
    EXPECT_GT(row.far_bits, 0);
    EXPECT_TRUE(!row.paper_bits || *row.paper_bits > 2 * row.far_bits);
    EXPECT_EQ(row.lookup.differ, 0);
    EXPECT_GT(row.lookup.samples, 10'000);
    for (const TerrainRays& rays : {row.near_rays, row.all_rays}) {
        EXPECT_GT(rays.rays, 5'000);
        EXPECT_EQ(rays.differ, 0);
    }
    // Short rays look at few cells anyway; long ones pass over most of theirs.
    EXPECT_LT(row.all_rays.looks, 0.75 * row.all_rays.plain_looks);
    const std::string page = terrain_markdown({row});
    EXPECT_NE(page.find("| ridges | 257 x 257 |"), std::string::npos) << page;
    const std::string table = terrain_csv({row});
    EXPECT_EQ(std::count(table.begin(), table.end(), ','), 2 * 29) << table;
}

TEST(TerrainBench, RefusesUnknownModels) {
    BenchOptions options = quick_options();
    options.scene = "no such ground";
    EXPECT_THROW(bench_terrain(options), UsageError);
}

}  // namespace
}  // namespace obscura
