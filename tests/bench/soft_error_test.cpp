// The bench of errors of soft shadows: more points are nearer to all of them, by every way, and its tables
// are whole.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "bench/shadows/results.h"
#include "bench/shadows/soft_error.h"

namespace obscura {
namespace {

TEST(SoftErrorBench, MorePointsAreNearerToAllOfThem) {
    BenchOptions options;
    options.quick = true;
    const std::vector<ShadowRecipe> recipes = shadow_recipes({}, true);
    ASSERT_FALSE(recipes.empty());
    const SoftErrorPlan plan = soft_error_plan(true);
    const std::vector<SoftErrorRow> rows = measure_soft_errors(recipes[0], plan, options);
    std::map<std::string, std::map<std::string, std::vector<double>>> errors;  // by light and method
    for (const SoftErrorRow& row : rows) {
        errors[row.light][row.method].push_back(row.rmse);
        EXPECT_GT(row.lookup_ms, 0);
        EXPECT_EQ(row.bytes > 0, row.method == stack_name);
        EXPECT_GT(row.covered, 4000u);
    }
    ASSERT_EQ(errors.size(), 2u);
    for (auto& [light, of] : errors) {
        SCOPED_TRACE(light);
        const std::vector<double>& exact = of[exact_name];
        ASSERT_EQ(exact.size(), plan.points.size());
        EXPECT_LT(exact[1], 0.6 * exact[0]);
        EXPECT_LT(exact[1], 0.03);
        // Maps of 256 texels are wrong along edges, whatever the points.
        EXPECT_LT(of[stack_name][1], exact[1] + 0.2);
#ifdef OBSCURA_HAS_EMBREE
        for (std::size_t i = 0; i < exact.size(); ++i)
            EXPECT_NEAR(of[embree_name][i], exact[i], 0.01);
#endif
    }
    const std::string csv = soft_error_csv(rows);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(rows.size()) + 1);
    EXPECT_EQ(soft_error_chart(rows, plan).panels.size(), 2u);
}

}  // namespace
}  // namespace obscura
