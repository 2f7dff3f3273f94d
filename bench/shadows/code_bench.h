#pragma once
// The part "trees" of the shadow bench: bytes of one tree in every code, and what merging found. Counts only,
// but for the seconds.

#include <cstdint>
#include <string>
#include <vector>

#include "bench/harness/options.h"
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

struct CodeRow {
    std::string scene;
    std::size_t triangles = 0;
    int size = 0;
    MultiresCounts nodes;
    std::uint64_t mh_bytes = 0;
    double build_s = 0, mh_s = 0;
    std::vector<MergeTrial> trials;
    std::vector<DagTrial> dag_trials;
    double ratio(const MergeTrial& trial) const {
        return static_cast<double>(trial.bytes) / static_cast<double>(mh_bytes);
    }
    /// Of the merged tree that is encoded when nothing is said.
    std::uint64_t mmh_bytes() const;
};

std::vector<CodeRow> measure_codes(const ShadowRecipe& recipe, const std::vector<int>& sizes, bool quick,
                                   const BenchOptions& options);

std::string code_csv(const std::vector<CodeRow>& rows);
std::string dag_csv(const std::vector<CodeRow>& rows);
std::string dag_markdown(const std::vector<CodeRow>& rows);
std::string code_markdown(const std::vector<CodeRow>& rows);

/// The whole part: writes shadows_codes.csv and shadows_codes.md. Returns an exit code. Throws UsageError
/// when options.scene is in no scene's name.
int bench_codes(const BenchOptions& options);

}  // namespace obscura
