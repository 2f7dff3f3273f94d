#pragma once
// The part "trees" of the shadow bench: one map in every code, beside what others have made of it, and what
// merging found.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/harness/options.h"
#include "bench/harness/panel_chart.h"
#include "bench/shadows/scenes.h"
#include "hierarchy/dag/dag.h"
#include "hierarchy/encode_params.h"
#include "hierarchy/mmh/merge.h"
#include "hierarchy/multires.h"

namespace obscura {

/// A way to merge: the paper counts all subtrees towards its limit.
struct MergeTrial {
    MergeParams params;
    std::uint64_t bytes = 0;
    MultiresCounts nodes;  ///< stored
    MergeStats stats;
    bool float_bits = false;
    double encode_s = 0;
    double share(std::uint64_t of) const {
        const std::uint64_t pairs =
            stats.interval_mismatch + stats.too_far + stats.full_rejected + stats.merged;
        return pairs == 0 ? 0 : 100 * static_cast<double>(of) / static_cast<double>(pairs);
    }
};
std::string trial_name(const MergeParams& params);

/// A way to cut a graph; the paper's tables 3 and 4.
struct DagTrial {
    DagParams params;
    std::uint64_t bytes = 0;
    DagStats stats;
    double encode_s = 0;
};

/// One way to keep a map, and what it costs.
struct CodeCost {
    std::string code;
    std::uint64_t bytes = 0;             ///< without a top grid
    double build_s = 0;                  ///< from triangles to bytes; 0: not timed
    std::array<double, 3> lookups = {};  ///< million a second and thread, kernels of 1, 3 and 5; 0: not timed
    std::uint64_t rounded_texels = 0;    ///< whose depth is not one of their interval
};
inline constexpr const char *dense_code = "dense", *constant_code = "scanlines, constant",
                            *linear_code = "scanlines, linear", *voxel_code = "voxel DAG";

struct CodeRow {
    std::string scene;
    std::size_t triangles = 0;
    int size = 0;
    MultiresCounts nodes;
    std::uint64_t mh_bytes = 0;
    double build_s = 0, mh_s = 0;
    std::vector<MergeTrial> trials;
    std::vector<DagTrial> dag_trials;
    std::vector<CodeCost> costs;
    double ratio(const MergeTrial& trial) const {
        return static_cast<double>(trial.bytes) / static_cast<double>(mh_bytes);
    }
    /// Of the merged tree that is encoded when nothing is said.
    std::uint64_t mmh_bytes() const;
    /// Null: not measured.
    const CodeCost* cost(const std::string& code) const;
};

std::vector<CodeRow> measure_codes(const ShadowRecipe& recipe, const std::vector<int>& sizes, bool quick,
                                   const BenchOptions& options);

/// Bytes, seconds and lookups of every code and peer.
std::string cost_csv(const std::vector<CodeRow>& rows);
std::string cost_markdown(const std::vector<CodeRow>& rows);
PanelChart cost_chart(const std::vector<CodeRow>& rows);
/// What merging and graphs found, by how they were asked.
std::string merge_csv(const std::vector<CodeRow>& rows);
std::string merge_markdown(const std::vector<CodeRow>& rows);
std::string dag_csv(const std::vector<CodeRow>& rows);
std::string dag_markdown(const std::vector<CodeRow>& rows);

/// The whole part: writes shadows_codes.csv, .md and with gnuplot .svg, shadows_mmh.csv and shadows_dag.csv.
/// Returns an exit code. Throws UsageError when options.scene is in no scene's name.
int bench_codes(const BenchOptions& options);

}  // namespace obscura
