#pragma once
// Which subtrees of a tree can be one.
//
// L. Scandolo, P. Bauszat, E. Eisemann, "Merged Multiresolution Hierarchies for Shadow Map Compression",
// Pacific Graphics 2016, section 3.2 and algorithm 3.

#include <cstdint>
#include <vector>

#include "core/isa.h"
#include "hierarchy/encode_params.h"
#include "hierarchy/mmh/subtrees.h"

namespace obscura {

/// Pairs of subtrees that were compared, and what came of it; the paper's table 3.
struct MergeStats {
    std::uint64_t interval_mismatch = 0;  ///< rejected by the extremes of their depths
    std::uint64_t too_far = 0;            ///< by the distance that an offset can span
    std::uint64_t full_rejected = 0;      ///< value by value
    std::uint64_t merged = 0;
    MergeStats& operator+=(const MergeStats& s) {
        interval_mismatch += s.interval_mismatch;
        too_far += s.too_far;
        full_rejected += s.full_rejected;
        merged += s.merged;
        return *this;
    }
    friend bool operator==(const MergeStats&, const MergeStats&) = default;
};

struct Merged {
    /// Of each subtree: the one that stands for it, behind it in the order; no_subtree: it stands for itself.
    std::vector<std::uint32_t> stands_for;
    /// Whether it is in the tree at all: no subtree around it was merged into another.
    std::vector<std::uint8_t> alive;
    std::vector<std::uint32_t> inherited;  ///< of those alive: the value that holds at the parent node
    std::vector<std::uint32_t> values;     ///< as SubtreeSet::values: chosen. Of subtrees that are gone: none
    MergeStats stats;

    /// What a parent of subtree `s` points to. (What stands for another was not merged itself.)
    std::uint32_t target(std::uint32_t s) const { return stands_for[s] == no_subtree ? s : stands_for[s]; }
    bool stored(std::uint32_t s) const { return alive[s] != 0 && stands_for[s] == no_subtree; }
};

/// Deterministic: the same for any exec.
Merged merge_subtrees(const SubtreeSet& set, const MergeParams& params, const Exec& exec);

}  // namespace obscura
