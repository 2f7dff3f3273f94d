#include "bench/shadows/code_costs.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include "app/frame/scene_light.h"
#include "bench/peer_codes/interval_bands.h"
#include "bench/peer_codes/scanlines.h"
#include "bench/peer_codes/voxel_dag.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "filters/shadow_lookup.h"
#include "filters/tree_pcf.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"

namespace obscura {
namespace {

struct CodeTrial {
    const char* name;
    ShadowCode code;
    DagParams dag = {};
};

/// As scenes get them, and the graph of the paper.
std::vector<CodeTrial> code_trials() {
    constexpr int paper_treelet_levels = 4, paper_chunk_log2 = 5;
    return {{"MH", ShadowCode::mh},
            {"MMH", ShadowCode::mmh},
            {"DAG-MH", ShadowCode::dag, {paper_treelet_levels, paper_chunk_log2, false}},
            {"DAG-MH, packed", ShadowCode::dag},
            {"facet", ShadowCode::facet}};
}

constexpr int kernel_sides[] = {1, 3, 5};

std::size_t asking_samples(const VisiblePoints& seen, const PcfLight& light) {
    std::size_t count = 0;
    for (const SurfaceBlock& block : seen.blocks) {
        for (int at = 0; at < block_samples; ++at)
            count += ref::pcf_place(block, light, at).asks() ? 1 : 0;
    }
    return count;
}

double seconds_of_lookups(const VisiblePoints& seen, const PcfLight& light) {
    alignas(64) float visible[block_samples];
    const Stopwatch watch;
    for (const SurfaceBlock& block : seen.blocks)
        OBSCURA_DISPATCH(best_isa(), pcf_block, block, light, visible);
    return watch.seconds();
}

/// Rows of a map as scanlines: so many segments.
std::uint64_t count_segments(ImageView<const DepthInterval> band, ScanFit fit, const Exec& exec) {
    std::vector<std::uint64_t> counts(static_cast<std::size_t>(band.height));
    parallel_for(counts.size(), exec, [&](std::size_t y) {
        std::vector<ScanSegment> row;
        fit_row({band.row(static_cast<int>(y)), static_cast<std::size_t>(band.width)}, fit, row);
        counts[y] = row.size();
    });
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts)
        sum += count;
    return sum;
}

}  // namespace

std::vector<CodeCost> tree_costs(const Scene& scene, const MultiresTree& tree, const LightView& view,
                                 const VisiblePoints& seen, double build_s, const BenchOptions& options) {
    std::vector<CodeCost> costs;
    std::vector<std::vector<ShadowTree>> trees;  // one each: pcf_light() wants a span
    for (const CodeTrial& trial : code_trials()) {
        EncodeParams params;
        params.code = trial.code;
        params.dag = trial.dag;
        params.exec = {best_isa(), options.threads.back()};
        params.top_levels = std::min(tree.levels, ShadowSettings{}.top_levels);
        const ShadowCodeRow& row = row_of(trial.code);
        const bool from_mesh = is_from_mesh(row, {});
        const Stopwatch watch;
        if (from_mesh) {
            trees.push_back({row.from_mesh(scene.mesh, view, {}, params, nullptr, nullptr)});
            set_top_grid(trees.back()[0], params.top_levels);
        } else {
            trees.push_back({encode_tree(tree, view, params)});
        }
        CodeCost cost;
        cost.code = trial.name;
        cost.bytes = trees.back()[0].bytes;
        cost.build_s = (from_mesh ? 0 : build_s) + watch.seconds();
        costs.push_back(std::move(cost));
    }
    // The shortest of some runs, in turns: what else the machine does is in none of them, if in few.
    for (std::size_t kernel = 0; kernel < std::size(kernel_sides); ++kernel) {
        const SceneLight light = shadow_light(scene, view.width, kernel_sides[kernel]);
        std::vector<double> shortest(trees.size(), 0);
        for (int run = 0; run <= options.runs; ++run) {
            for (std::size_t i = 0; i < trees.size(); ++i) {
                const double s = seconds_of_lookups(
                    seen, pcf_light(light, std::span<const ShadowTree>(trees[i]), scene.camera.eye));
                shortest[i] = run == 0 ? s : std::min(shortest[i], s);
            }
        }
        const auto asked = static_cast<double>(
            asking_samples(seen, pcf_light(light, std::span<const ShadowTree>(trees[0]), scene.camera.eye)));
        for (std::size_t i = 0; i < trees.size(); ++i)
            costs[i].lookups[kernel] = 1e-6 * asked / shortest[i];
    }
    return costs;
}

std::vector<CodeCost> peer_costs(const Scene& scene, const LightView& view, const Exec& exec) {
    // Intervals are made once for all, so none is timed.
    std::vector<CodeCost> costs;
    const auto add = [&](const char* code, std::uint64_t bytes, std::uint64_t rounded = 0) {
        CodeCost cost;
        cost.code = code;
        cost.bytes = bytes;
        cost.rounded_texels = rounded;
        costs.push_back(std::move(cost));
    };
    constexpr int most_band_rows = 256;
    VoxelDag voxels(std::countr_zero(static_cast<unsigned>(view.width)));
    std::uint64_t constant = 0, linear = 0;
    for_each_band(scene.mesh, view, std::min(view.height, most_band_rows), exec,
                  [&](int, ImageView<const DepthInterval> band) {
                      constant += count_segments(band, ScanFit::constant, exec);
                      linear += count_segments(band, ScanFit::linear, exec);
                      voxels.add_band(band);
                  });
    voxels.finish();
    const auto rows = static_cast<std::uint64_t>(view.height);
    add(dense_code, rows * rows * sizeof(float));
    add(constant_code, scanline_bytes(ScanFit::constant, constant, rows));
    add(linear_code, scanline_bytes(ScanFit::linear, linear, rows));
    add(voxel_code, voxels.bytes(), voxels.rounded_texels());
    return costs;
}

}  // namespace obscura
