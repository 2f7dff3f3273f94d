// The bench of stacks: what a small run finds is true of every stack, and its tables are whole.

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/shadows/stack_bench.h"

namespace obscura {
namespace {

TEST(StackBench, ASmallRun) {
    BenchOptions options;
    options.quick = true;
    const std::vector<ShadowRecipe> recipes = shadow_recipes({}, true);
    ASSERT_FALSE(recipes.empty());
    std::vector<StackRow> rows;
    for (const StackSubject& subject : stack_subjects(recipes[0].name, true))
        rows.push_back(measure_stack(recipes[0], subject, options));
    ASSERT_EQ(rows.size(), 2u);
    for (const StackRow& row : rows) {
        EXPECT_GT(row.bytes, 0u);
        EXPECT_LT(row.ratio(), 1) << "never above the sum of the quadtrees";
        EXPECT_GT(row.trials.size(), 3u);
    }
    const StackRow& focused = rows[1];
    EXPECT_LT(focused.ratio(), rows[0].ratio()) << "aiming together pays";
    EXPECT_GT(focused.penumbra, 0u);
    EXPECT_LT(focused.everywhere.all * 2, focused.everywhere.each);
    EXPECT_LT(focused.everywhere.all * 2, focused.everywhere.quadtrees);
    const std::string csv = stack_csv(rows);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
    EXPECT_NE(stack_markdown(rows).find("| city | 64 | 16 | 5 | ground |"), std::string::npos);
}

}  // namespace
}  // namespace obscura
