#include "bench/shadows/shadow_bench.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/harness/report.h"
#include "bench/shadows/code_bench.h"
#include "bench/shadows/exact_bench.h"
#include "bench/shadows/report.h"
#include "bench/shadows/soft_bench.h"
#include "bench/shadows/soft_error.h"
#include "bench/shadows/stack_bench.h"
#include "bench/shadows/sweep_scenes.h"
#ifdef OBSCURA_HAS_EMBREE
#include "bench/shadows/wrong_sweep.h"
#endif
#include "core/error.h"

namespace obscura {
namespace {

/// 1k, 2k, ... up to `last`.
std::vector<int> doublings(int first, int last) {
    std::vector<int> sizes;
    for (int size = first; size <= last; size *= 2)
        sizes.push_back(size);
    return sizes;
}

std::vector<ShadowRecipe> recipes_of(const BenchOptions& options, std::vector<ShadowRecipe> all) {
    std::vector<ShadowRecipe> chosen;
    for (ShadowRecipe& recipe : all) {
        if (recipe.name.find(options.scene) != std::string::npos) chosen.push_back(std::move(recipe));
    }
    check_chosen(!chosen.empty(), options);
    return chosen;
}

}  // namespace

ShadowBenchPlan shadow_bench_plan(bool quick) {
    ShadowBenchPlan plan;
    if (quick) {
        plan.picture = {320, 180};
        plan.dense_sizes = {256, 512, 1024};
        plan.compressed_sizes = {256, 512, 1024, 2048};
        plan.timed_dense_sizes = {256, 1024};
        plan.timed_compressed_sizes = {1024, 4096};
        plan.tree_sizes = {256, 512, 1024};
        plan.direction_sizes = {128};
        plan.picture_size = 256;
        plan.peer_map = 512;
        return plan;
    }
    plan.dense_sizes = doublings(1024, 16384);
    plan.compressed_sizes = doublings(1024, 1 << 20);
    plan.timed_dense_sizes = {4096, 16384};
    plan.timed_compressed_sizes = {16384, 65536, 262144, 1048576};
    plan.tree_sizes = doublings(1024, 1 << 20);
    plan.direction_sizes = {1024, 2048};
    plan.timed_scenes = {"city", "vienna_west", "armadillo"};
    return plan;
}

bool is_timed(const ShadowBenchPlan& plan, const std::string& scene) {
    const auto& timed = plan.timed_scenes;
    return timed.empty() || std::find(timed.begin(), timed.end(), scene) != timed.end();
}

std::string left_out(const ShadowBenchPlan& plan, const std::string& scene, int size, double last_s,
                     std::int64_t last_bytes) {
    constexpr double longest_s = 40;
    constexpr std::int64_t largest_bytes = 200'000'000;
    if (size > plan.shallow_size && !is_timed(plan, scene)) return "left out: not one of the timed scenes";
    if (last_s > longest_s) return fmt::format("left out: the map before took {:.0f} s", last_s);
    if (last_bytes > largest_bytes)
        return fmt::format("left out: the map before took {} MB", last_bytes / 1'000'000);
    return {};
}

int bench_shadows(const BenchOptions& options, const std::vector<Contestant>& peers) {
    // Reports of their own.
    if (options.part == "exact") {
        make_output_folder(options);
        return bench_exact(options);
    }
    if (options.part == "soft") {
        make_output_folder(options);
        return bench_soft(options);
    }
    if (options.part == "soft-error") {
        make_output_folder(options);
        return bench_soft_error(options);
    }
    if (options.part == "stack") {
        make_output_folder(options);
        return bench_stack(options);
    }
    if (options.part == "trees") {
        make_output_folder(options);
        return bench_codes(options);
    }
    const auto wants = [&](const char* part) { return options.part.empty() || options.part == part; };
    const ShadowBenchPlan plan = shadow_bench_plan(options.quick);
    const bool sweeps = options.part == "wrong-pixels";
    const std::vector<ShadowRecipe> recipes = recipes_of(
        options, sweeps && options.data && !options.quick ? sweep_recipes(*options.data)
                                                          : shadow_recipes(options.data, options.quick));
    make_output_folder(options);
    ShadowResults results;
    // Times first: their workers must be forked before this process starts threads.
    for (const ShadowRecipe& recipe : recipes) {
        if (!wants("times")) break;
        for (TimeRow& row : measure_shadow_times(recipe, plan, options))
            results.times.push_back(std::move(row));
        if (!is_timed(plan, recipe.name)) continue;
        for (TimeRow& row : measure_dual_depths(recipe, plan, peers, options))
            results.times.push_back(std::move(row));
    }
    for (const ShadowRecipe& recipe : recipes) {
        if (!wants("sizes")) break;
        for (DirectionRow& row : measure_directions(recipe, plan, options))
            results.directions.push_back(std::move(row));
        for (SizeRow& row : measure_trees(recipe, plan, options))
            results.sizes.push_back(std::move(row));
    }
    for (const ShadowRecipe& recipe : recipes) {
        if (!wants("accuracy")) break;
#ifdef OBSCURA_HAS_EMBREE
        for (AccuracyRow& row : measure_accuracy(recipe, plan, options))
            results.accuracy.push_back(std::move(row));
#else
        options.say(
            fmt::format("{}: this build has no Embree, so no exact rays to compare with", recipe.name));
#endif
    }
    for (const ShadowRecipe& recipe : recipes) {
        if (!wants("wrong-pixels")) break;
#ifdef OBSCURA_HAS_EMBREE
        for (SweepRow& row : measure_sweep(recipe, plan, options))
            results.sweep.push_back(std::move(row));
#endif
    }
    write_shadow_report(results, options);
    draw_shadow_charts(results, options);
    options.say(fmt::format("written to {}", options.out.string()));
    const bool failed = std::any_of(results.times.begin(), results.times.end(), [](const TimeRow& row) {
        const bool ours = row.method == dense_name || row.method == compressed_name;
        return !row.problem.empty() && ours;
    });
    return static_cast<int>(failed ? ExitCode::internal : ExitCode::ok);
}

}  // namespace obscura
