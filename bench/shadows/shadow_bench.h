#pragma once
// `obscura bench shadows`: dense and compressed shadow maps beside exact rays.

#include <string>
#include <vector>

#include "bench/harness/contestant.h"
#include "bench/harness/options.h"
#include "bench/shadows/results.h"
#include "bench/shadows/scenes.h"

namespace obscura {

/// What a run asks for.
struct ShadowBenchPlan {
    PictureSize picture;
    std::vector<int> dense_sizes, compressed_sizes;              ///< of the accuracy chart
    std::vector<int> timed_dense_sizes, timed_compressed_sizes;  ///< of the lookups
    std::vector<int> tree_sizes;                                 ///< of the table of trees
    std::vector<int> direction_sizes;                            ///< top-down against bottom-up
    int peer_map = 16384;                                        ///< of the peers' dual depths
    std::vector<std::string> timed_scenes;                       ///< at all sizes; empty: all
    int shallow_timed_size = 16384;                              ///< largest timed map of the others
    int shallow_size = 65536;                                    ///< largest tree of the others
    int picture_size = 4096;                                     ///< map whose wrong pixels are painted
};
ShadowBenchPlan shadow_bench_plan(bool quick);
/// Whether lookups are timed on that scene at all sizes.
bool is_timed(const ShadowBenchPlan& plan, const std::string& scene);

/// Why the next tree of a scene is left out, empty if it is not: scenes that are not timed stop at
/// plan.shallow_size, and trees that grow with the area of their map (open scans) where it gets out of hand.
std::string left_out(const ShadowBenchPlan& plan, const std::string& scene, int size, double last_s,
                     std::int64_t last_bytes);

/// The whole bench: measures, writes shadows*.csv, shadows.md, with gnuplot SVG charts, and a picture per
/// scene into options.out. Returns an exit code. Throws OutputError.
/// options.part: "times", "accuracy", "wrong-pixels" or "sizes" alone, or "exact", "soft", "stack" or
/// "trees", which no other run has (exact_bench.h, stack_bench.h, code_bench.h). `peers`: whose dual-depth
/// maps are timed beside builds.
int bench_shadows(const BenchOptions& options, const std::vector<Contestant>& peers);

// Its parts, scene by scene.

/// Lookup and build times of every method and thread count, each method in a process of its own. Call before
/// this process starts any thread.
std::vector<TimeRow> measure_shadow_times(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                          const BenchOptions& options);

/// Dual-depth maps of plan.peer_map texels a side, by the peers' methods: what building a tree is measured
/// against. One run each. Call before this process starts any thread.
std::vector<TimeRow> measure_dual_depths(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                         const std::vector<Contestant>& peers, const BenchOptions& options);

/// Trees of the sizes of plan.tree_sizes, in this process.
std::vector<SizeRow> measure_trees(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                   const BenchOptions& options);

/// Both constructions over the same intervals.
std::vector<DirectionRow> measure_directions(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                             const BenchOptions& options);

/// Wrong pixels of every method and size; writes the scene's picture. Only with Embree.
std::vector<AccuracyRow> measure_accuracy(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                          const BenchOptions& options);

}  // namespace obscura
