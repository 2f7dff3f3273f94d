#include "bench/shadows/code_bench.h"

#include <fmt/format.h>

#include <utility>

#include "app/frame/scene_light.h"
#include "bench/harness/gnuplot.h"
#include "bench/harness/panel_chart.h"
#include "bench/harness/report.h"
#include "bench/shadows/code_costs.h"
#include "bench/shadows/shadow_bench.h"
#include "bench/shadows/visible_points.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/mmh/mmh.h"

namespace obscura {
namespace {

/// The paper's limits in its own way of counting, then ours, then all.
std::vector<MergeParams> merge_trials() {
    std::vector<MergeParams> trials;
    for (const int limit : {100, 500, 1000}) {
        MergeParams params;
        params.search_limit = limit;
        params.count_survivors = false;
        trials.push_back(params);
    }
    trials.push_back({});
    MergeParams all;
    all.search_limit = 0;
    trials.push_back(all);
    return trials;
}

MergeTrial merge(const MultiresTree& tree, const LightView& view, const MergeParams& how, const Exec& exec) {
    EncodeParams params;
    params.code = ShadowCode::mmh;
    params.merge = how;
    params.exec = exec;
    MergeTrial trial;
    trial.params = how;
    const Stopwatch watch;
    const ShadowTree merged = encode_mmh(tree, view, params, &trial.stats);
    trial.encode_s = watch.seconds();
    trial.bytes = merged.bytes;
    trial.nodes = merged.counts;
    trial.float_bits = merged.code.layout == TreeLayout::float_bits;
    return trial;
}

/// The paper's; other treelets; other chunks; packed, with chunks of 32, 64 and 128.
std::vector<DagParams> dag_trials() {
    constexpr int treelet_levels = 4, chunk_log2 = 5;
    std::vector<DagParams> trials{{treelet_levels, chunk_log2, false}};
    for (const int levels : {1, 2, 3, 5})
        trials.push_back({levels, chunk_log2, false});
    for (const int chunk : {4, 6, 7})
        trials.push_back({treelet_levels, chunk, false});
    for (const int chunk : {5, 6, 7})
        trials.push_back({treelet_levels, chunk, true});
    return trials;
}

DagTrial encode_dag_as(const MultiresTree& tree, const LightView& view, const DagParams& how,
                       const Exec& exec) {
    EncodeParams params;
    params.code = ShadowCode::dag;
    params.dag = how;
    params.exec = exec;
    DagTrial trial;
    trial.params = how;
    const Stopwatch watch;
    const ShadowTree encoded = encode_tree(tree, view, params);
    trial.encode_s = watch.seconds();
    trial.bytes = encoded.bytes;
    trial.stats = dag_stats(encoded);
    return trial;
}

}  // namespace

std::vector<CodeRow> measure_codes(const ShadowRecipe& recipe, const std::vector<int>& sizes, bool quick,
                                   const BenchOptions& options) {
    const ShadowBenchPlan plan = shadow_bench_plan(quick);
    const Scene scene = stage_shadows(recipe, plan.picture);
    const Exec exec{best_isa(), options.threads.back()};
    const VisiblePoints seen = visible_points(scene, exec);
    // Open scans grow as the square of the side: a tree that would be larger than this is left out.
    constexpr double largest_bytes = 40e6;
    std::vector<CodeRow> rows;
    for (const int size : sizes) {
        const std::size_t done = rows.size();
        if (done > 1) {
            const auto last = static_cast<double>(rows[done - 1].mh_bytes);
            if (last * last / static_cast<double>(rows[done - 2].mh_bytes) > largest_bytes) break;
        }
        CodeRow row;
        row.scene = recipe.name;
        row.triangles = scene.mesh.triangles.size();
        row.size = size;
        const LightView view = shadow_views(shadow_light(scene, size, 1), bounds_of(scene.mesh))[0];
        BuildParams build;
        build.keep_intervals = true;
        Stopwatch watch;
        const MultiresTree tree = build_shadow_tree(scene.mesh, view, build, exec);
        row.build_s = watch.seconds();
        row.nodes = count_nodes(tree);
        watch = Stopwatch();
        row.mh_bytes = encode_tree(tree, view).bytes;
        row.mh_s = watch.seconds();
        // Looking at all pairs is quadratic.
        constexpr int largest_for_all = 16384;
        for (const MergeParams& how : merge_trials()) {
            if (how.search_limit == 0 && size > largest_for_all) continue;
            row.trials.push_back(merge(tree, view, how, exec));
            const MergeTrial& trial = row.trials.back();
            options.say(fmt::format("{}, {}: mh {} bytes, mmh {} {:.3f} of it, {:.2f} s", row.scene, size,
                                    row.mh_bytes, trial_name(how), row.ratio(trial), trial.encode_s));
        }
        for (const DagParams& how : dag_trials()) {
            row.dag_trials.push_back(encode_dag_as(tree, view, how, exec));
            const DagTrial& trial = row.dag_trials.back();
            options.say(fmt::format("{}, {}: {}graph of {} levels, chunks of {}: {} bytes, {:.2f} s",
                                    row.scene, size, how.packed ? "packed " : "", how.treelet_levels,
                                    1 << how.chunk_log2, trial.bytes, trial.encode_s));
        }
        row.costs = tree_costs(scene, tree, view, seen, row.build_s, options);
        const bool looks_at_texels = size <= plan.shallow_timed_size || is_timed(plan, recipe.name);
        for (CodeCost& cost : looks_at_texels ? peer_costs(scene, view, exec) : std::vector<CodeCost>())
            row.costs.push_back(std::move(cost));
        for (const CodeCost& cost : row.costs)
            options.say(fmt::format("{}, {}: {} {} bytes", row.scene, size, cost.code, cost.bytes));
        rows.push_back(std::move(row));
    }
    return rows;
}

int bench_codes(const BenchOptions& options) {
    const std::vector<int> sizes =
        options.quick ? std::vector<int>{256, 512} : std::vector<int>{1024, 4096, 16384, 65536};
    const bool draws = can_draw(options);
    std::vector<CodeRow> rows;
    for (const ShadowRecipe& recipe : shadow_recipes(options.data, options.quick)) {
        if (recipe.name.find(options.scene) == std::string::npos) continue;
        for (CodeRow& row : measure_codes(recipe, sizes, options.quick, options))
            rows.push_back(std::move(row));
        // After every scene: a run that is stopped leaves what it has.
        write_files(options, {{"shadows_codes.csv", cost_csv(rows)},
                              {"shadows_mmh.csv", merge_csv(rows)},
                              {"shadows_dag.csv", dag_csv(rows)},
                              {"shadows_codes.md",
                               report_head("Shadow trees by code", "a small scene", options) +
                                   cost_markdown(rows) + merge_markdown(rows) + dag_markdown(rows)}});
        if (draws) run_gnuplot(panel_script(cost_chart(rows)), options.out / "shadows_codes.svg");
    }
    check_chosen(!rows.empty(), options);
    options.say(fmt::format("written to {}", options.out.string()));
    return static_cast<int>(ExitCode::ok);
}

}  // namespace obscura
