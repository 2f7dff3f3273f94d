// The bench of tree codes: what a small run finds is true of every map, and its tables and chart are whole.

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/shadows/code_bench.h"

namespace obscura {
namespace {

TEST(CodeBench, ASmallRun) {
    BenchOptions options;
    options.quick = true;
    options.runs = 1;
    const std::vector<ShadowRecipe> recipes = shadow_recipes({}, true);
    ASSERT_FALSE(recipes.empty());
    const std::vector<CodeRow> rows = measure_codes(recipes[0], {128, 256}, true, options);
    ASSERT_EQ(rows.size(), 2u);
    for (const CodeRow& row : rows) {
        ASSERT_EQ(row.costs.size(), 9u);
        const auto bytes = [&](const char* code) {
            const CodeCost* cost = row.cost(code);
            EXPECT_NE(cost, nullptr) << code;
            return cost == nullptr ? 0 : cost->bytes;
        };
        EXPECT_EQ(bytes("MH"), row.mh_bytes);
        EXPECT_EQ(bytes("MMH"), row.mmh_bytes());
        EXPECT_LT(bytes("MMH"), bytes("MH"));
        EXPECT_LT(bytes("DAG-MH, packed"), bytes("DAG-MH"));
        EXPECT_GT(bytes("facet"), 0u);
        EXPECT_EQ(bytes(dense_code),
                  4 * static_cast<std::uint64_t>(row.size) * static_cast<std::uint64_t>(row.size));
        EXPECT_LT(bytes(constant_code), bytes(dense_code));
        // A line serves at least the texels that a depth does, and is half as large again.
        EXPECT_LT(2 * bytes(linear_code), 3 * bytes(constant_code));
        EXPECT_GT(bytes(voxel_code), 0u);
        for (const CodeCost& cost : row.costs) {
            const bool ours = cost.build_s > 0;
            for (const double rate : cost.lookups)
                EXPECT_EQ(rate > 0, ours) << cost.code;
        }
    }
    const std::string csv = cost_csv(rows);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 9);
    EXPECT_NE(cost_markdown(rows).find("| city | 256 | voxel DAG |"), std::string::npos);
    const PanelChart chart = cost_chart(rows);
    ASSERT_EQ(chart.panels.size(), 1u);
    EXPECT_EQ(chart.panels[0].lines.size(), 9u);
    EXPECT_EQ(chart.panels[0].lines[0].points.size(), 2u);
}

}  // namespace
}  // namespace obscura
