// Sizes and construction of trees: what the papers' tables tell.

#include <fmt/format.h>

#include "app/frame/scene_light.h"
#include "bench/harness/peak_memory.h"
#include "bench/shadows/shadow_bench.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "hierarchy/codes/codes.h"
#include "raster/shadow_map.h"

namespace obscura {
namespace {

std::int64_t encoded_bytes(const MultiresTree& tree, const LightView& view, TreeLayout layout) {
    EncodeParams params;
    params.layout = layout;
    return static_cast<std::int64_t>(encode_tree(tree, view, params).bytes);
}

void build_and_encode(const Scene& scene, int size, const Exec& exec, SizeRow& row) {
    const LightView view = shadow_views(shadow_light(scene, size, 1), bounds_of(scene.mesh))[0];
    const PeakMemory memory;
    Stopwatch watch;
    const MultiresTree tree = build_shadow_tree(scene.mesh, view, {}, exec, &row.stats);
    row.build_s = watch.seconds();
    watch = Stopwatch();
    row.words24 = encoded_bytes(tree, view, TreeLayout::words24);
    row.encode_s = watch.seconds();
    row.peak_bytes = memory.bytes();
    row.words16 = encoded_bytes(tree, view, TreeLayout::words16);
    row.bytes16 = encoded_bytes(tree, view, TreeLayout::bytes16);
    row.nodes = count_nodes(tree);
}

}  // namespace

std::vector<SizeRow> measure_trees(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                   const BenchOptions& options) {
    const Scene scene = stage_shadows(recipe, plan.picture);
    const Exec exec{best_isa(), options.threads.back()};
    std::vector<SizeRow> rows;
    double last_s = 0;
    std::int64_t last_bytes = 0;
    for (const int size : plan.tree_sizes) {
        SizeRow row;
        row.scene = recipe.name;
        row.triangles = scene.mesh.triangles.size();
        row.size = size;
        row.problem = left_out(plan, row.scene, size, last_s, last_bytes);
        if (row.problem.empty()) {
            build_and_encode(scene, size, exec, row);
            last_s = row.build_s;
            last_bytes = row.words24;
        }
        options.say(
            row.problem.empty()
                ? fmt::format("{}, tree {}: {:.2f} s + {:.2f} s, {:.3f} MB, {} nodes, peak {:.0f} MiB",
                              row.scene, size, row.build_s, row.encode_s,
                              static_cast<double>(row.words24) * 1e-6,
                              row.nodes.full + row.nodes.empty + row.nodes.leaf,
                              static_cast<double>(row.peak_bytes) / (1 << 20))
                : fmt::format("{}, tree {}: {}", row.scene, size, row.problem));
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<DirectionRow> measure_directions(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                             const BenchOptions& options) {
    const Scene scene = stage_shadows(recipe, plan.picture);
    std::vector<DirectionRow> rows;
    for (const int size : plan.direction_sizes) {
        const LightView view = shadow_views(shadow_light(scene, size, 1), bounds_of(scene.mesh))[0];
        const Image<DepthInterval> intervals = interval_map(scene.mesh, view, {}, Exec{});
        DirectionRow row;
        row.scene = recipe.name;
        row.size = size;
        Stopwatch watch;
        const MultiresTree up = build_bottom_up(intervals.view());
        row.bottom_up_s = watch.seconds();
        watch = Stopwatch();
        const MultiresTree down = build_top_down(intervals.view());
        row.top_down_s = watch.seconds();
        row.bottom_up = count_nodes(up);
        row.top_down = count_nodes(down);
        row.bottom_up_bytes = encoded_bytes(up, view, TreeLayout::words24);
        row.top_down_bytes = encoded_bytes(down, view, TreeLayout::words24);
        options.say(fmt::format("{}, {}: bottom-up {} bytes in {:.3f} s, top-down {} in {:.3f} s", row.scene,
                                size, row.bottom_up_bytes, row.bottom_up_s, row.top_down_bytes,
                                row.top_down_s));
        rows.push_back(row);
    }
    return rows;
}

}  // namespace obscura
