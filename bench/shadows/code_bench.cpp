#include "bench/shadows/code_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "app/frame/scene_light.h"
#include "bench/harness/report.h"
#include "bench/shadows/shadow_bench.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/mmh/mmh.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

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

double mb(std::uint64_t bytes) {
    return static_cast<double>(bytes) * 1e-6;
}

}  // namespace

std::uint64_t CodeRow::mmh_bytes() const {
    for (const MergeTrial& trial : trials) {
        if (trial.params.count_survivors && trial.params.search_limit != 0) return trial.bytes;
    }
    return 0;
}

std::string trial_name(const MergeParams& params) {
    if (params.search_limit == 0) return "all";
    return fmt::format("{}{}", params.search_limit, params.count_survivors ? " survivors" : "");
}

std::vector<CodeRow> measure_codes(const ShadowRecipe& recipe, const std::vector<int>& sizes, bool quick,
                                   const BenchOptions& options) {
    const Scene scene = stage_shadows(recipe, shadow_bench_plan(quick).picture);
    const Exec exec{best_isa(), options.threads.back()};
    // Open scans grow as the square of the side: sixteen times from size to size.
    constexpr std::uint64_t largest_bytes = 200'000'000;
    std::vector<CodeRow> rows;
    for (const int size : sizes) {
        if (!rows.empty() && 16 * rows.back().mh_bytes > largest_bytes) break;
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
        rows.push_back(std::move(row));
    }
    return rows;
}

std::string code_csv(const std::vector<CodeRow>& rows) {
    std::string text =
        "scene,triangles,size,full,empty,leaf,mh_bytes,build_s,mh_s,search,mmh_bytes,ratio,mmh_full,mmh_"
        "empty,"
        "mmh_leaf,merged,interval_percent,distance_percent,full_test_percent,float_bits,mmh_s\n";
    for (const CodeRow& row : rows) {
        for (const MergeTrial& trial : row.trials) {
            fmt::format_to(Out(text), "{},{},{},{},{},{},{},{:.3f},{:.3f},{},{},{:.4f},{},{},{},{},",
                           row.scene, row.triangles, row.size, row.nodes.full, row.nodes.empty,
                           row.nodes.leaf, row.mh_bytes, row.build_s, row.mh_s, trial_name(trial.params),
                           trial.bytes, row.ratio(trial), trial.nodes.full, trial.nodes.empty,
                           trial.nodes.leaf, trial.stats.merged);
            fmt::format_to(Out(text), "{:.2f},{:.2f},{:.2f},{},{:.3f}\n",
                           trial.share(trial.stats.interval_mismatch), trial.share(trial.stats.too_far),
                           trial.share(trial.stats.full_rejected), trial.float_bits ? 1 : 0, trial.encode_s);
        }
    }
    return text;
}

std::string code_markdown(const std::vector<CodeRow>& rows) {
    std::string text =
        "## Bytes\n\nMMH over MH (words24), by how many subtrees of equal topology each is compared "
        "with: of all, as the paper counts, of those that were not merged, all.\n\n"
        "| scene | texels | nodes | MH, MB | 100 | 500 | 1000 | 1000 survivors | all |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const CodeRow& row : rows) {
        fmt::format_to(Out(text), "| {} | {} | {} | {:.2f} |", row.scene, row.size,
                       row.nodes.full + row.nodes.empty + row.nodes.leaf,
                       static_cast<double>(row.mh_bytes) * 1e-6);
        for (std::size_t i = 0; i < merge_trials().size(); ++i) {
            text += i < row.trials.size() ? fmt::format(" {:.3f} |", row.ratio(row.trials[i])) : " - |";
        }
        text += "\n";
    }
    text +=
        "\n## Pairs\n\nWhat became of the pairs that were compared, 1000 survivors, in percent; the paper's "
        "table 3 has "
        "62 to 67, 0 to 14 and 24 to 36 of those rejected.\n\n"
        "| scene | texels | extremes apart | too far | value by value | merged | s "
        "|\n|---|--:|--:|--:|--:|--:|--:|\n";
    for (const CodeRow& row : rows) {
        for (const MergeTrial& trial : row.trials) {
            if (!trial.params.count_survivors || trial.params.search_limit == 0) continue;
            fmt::format_to(Out(text), "| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.2f} |\n", row.scene,
                           row.size, trial.share(trial.stats.interval_mismatch),
                           trial.share(trial.stats.too_far), trial.share(trial.stats.full_rejected),
                           trial.share(trial.stats.merged), trial.encode_s);
        }
    }
    return text;
}

std::string dag_csv(const std::vector<CodeRow>& rows) {
    std::string text =
        "scene,size,mh_bytes,mmh_bytes,packed,treelet_levels,chunk,dag_bytes,inner_nodes,inner_bytes,"
        "treelets,"
        "treelet_bytes,values,chunk_bytes,factors,factor_bytes,dag_s\n";
    for (const CodeRow& row : rows) {
        for (const DagTrial& trial : row.dag_trials) {
            const DagStats& s = trial.stats;
            fmt::format_to(Out(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3f}\n", row.scene,
                           row.size, row.mh_bytes, row.mmh_bytes(), trial.params.packed ? 1 : 0,
                           trial.params.treelet_levels, 1 << trial.params.chunk_log2, trial.bytes,
                           s.inner_nodes, s.inner_bytes, s.treelets, s.treelet_bytes, s.values, s.chunk_bytes,
                           s.factors, s.factor_bytes, trial.encode_s);
        }
    }
    return text;
}

std::string dag_markdown(const std::vector<CodeRow>& rows) {
    std::string text =
        "\n## Graphs\n\nAs the paper has them, with treelets of four levels and chunks of 32; then bytes "
        "over theirs "
        "with other treelets and chunks, and packed. MMH: 1000 survivors.\n\n"
        "| scene | texels | DAG, MB | structure | values | /MH | /MMH | 1 level | 2 | 3 | 5 | chunks of 16 | "
        "64 | "
        "128 | packed, 32 | 64 | 128 | with factor, % | bits of one | s |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const CodeRow& row : rows) {
        const DagTrial& first = row.dag_trials.front();
        const auto over = [&](std::uint64_t bytes) {
            return static_cast<double>(first.bytes) / static_cast<double>(bytes);
        };
        fmt::format_to(Out(text), "| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.3f} | {:.3f} |", row.scene,
                       row.size, mb(first.bytes), mb(first.stats.structure_bytes()),
                       mb(first.stats.value_bytes()), over(row.mh_bytes), over(row.mmh_bytes()));
        for (std::size_t i = 1; i < row.dag_trials.size(); ++i)
            fmt::format_to(Out(text), " {:.3f} |", 1 / over(row.dag_trials[i].bytes));
        const auto factors = static_cast<double>(std::max<std::uint64_t>(first.stats.factors, 1));
        fmt::format_to(Out(text), " {:.1f} | {:.1f} | {:.2f} |\n",
                       100 * factors / static_cast<double>(first.stats.values),
                       8 * static_cast<double>(first.stats.factor_bytes) / factors, first.encode_s);
    }
    return text;
}

int bench_codes(const BenchOptions& options) {
    const std::vector<int> sizes =
        options.quick ? std::vector<int>{256, 512} : std::vector<int>{4096, 16384, 65536};
    std::vector<CodeRow> rows;
    bool found = false;
    for (const ShadowRecipe& recipe : shadow_recipes(options.data, options.quick)) {
        if (recipe.name.find(options.scene) == std::string::npos) continue;
        found = true;
        for (CodeRow& row : measure_codes(recipe, sizes, options.quick, options))
            rows.push_back(std::move(row));
    }
    if (!found) throw UsageError(fmt::format("no bench scene has \"{}\" in its name", options.scene));
    write_files(options, {{"shadows_codes.csv", code_csv(rows)},
                          {"shadows_dag.csv", dag_csv(rows)},
                          {"shadows_codes.md", report_head("Shadow trees by code", "a small scene", options) +
                                                   code_markdown(rows) + dag_markdown(rows)}});
    options.say(fmt::format("written to {}", options.out.string()));
    return static_cast<int>(ExitCode::ok);
}

}  // namespace obscura
