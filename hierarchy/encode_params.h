#pragma once
// How a tree is to be written: what the codes are asked.

#include <cstdint>

#include "core/isa.h"
#include "hierarchy/tree_code.h"

namespace obscura {

/// mmh: how subtrees that can be one are looked for.
struct MergeParams {
    /// Of the subtrees of equal topology that stand behind one in depth-first order, so many are compared
    /// with it; 0: all.
    int search_limit = 1000;
    /// What counts towards the limit: only subtrees that were not merged themselves; or all, as the paper has
    /// it.
    bool count_survivors = true;
    /// Farthest that a shared subtree may stand behind a node that points to it, in words, and the greatest
    /// height of such a node: less for tests. Both are lowered where the layout asks for it.
    std::uint64_t max_distance = (1u << 24) - 1;
    int max_height = max_tree_levels;
};

/// dag: in what pieces.
struct DagParams {
    int treelet_levels = 4;  ///< 1 to 5
    int chunk_log2 = 6;      ///< values in chunks of 2^this: 4 to 7
    bool packed = true;      ///< in fewer bits than the paper's
    /// Values below the root for which nodes have 24 bits; with more they have a word. Less for tests.
    std::uint64_t most_counted = (1u << 24) - 1;
};

struct EncodeParams {
    TreeLayout layout = TreeLayout::words24;  ///< mh: what to try first
    int top_levels = 0;   ///< levels in the dense top grid, in [0, min(levels, max_top_levels)]; 0: no grid
    int offset_bits = 0;  ///< fewer bits for offsets, for tests, at least min_offset_bits; 0: the layout's
    /// mh: of the nodes' own bytes: beyond it the next wider layout is taken.
    double bearable_padding = 1.0 / 8;
    std::uint64_t max_units = std::uint64_t{1} << 31;  ///< of the result; less for tests
    ShadowCode code = ShadowCode::mh;
    MergeParams merge = {};
    DagParams dag = {};
    Exec exec = {};  ///< mmh, dag; the result does not depend on it
};

constexpr int min_offset_bits = 4;  ///< with fewer, four siblings cannot each reach their children

}  // namespace obscura
