#pragma once
// The octree of a stack from its maps, one after the other: a binary counter of runs (slab.h).

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/isa.h"
#include "hierarchy/certain_tree.h"
#include "hierarchy/multires.h"
#include "hierarchy/stack/stack_shape.h"

namespace obscura {

struct StackTreeParams {
    /// Anisotropies to try, in [-64, 64]; what a stack has no room for counts as the most it has room for.
    /// All are built side by side from the same maps, and the tree of fewest bytes is kept, the first of
    /// several.
    std::vector<int> anisotropies = {0, -1, -2, -3, -4, -5, 1, 2, 3, 4};
    /// A tree of more nodes is given up; LimitError when all are.
    std::uint64_t max_nodes = UINT64_MAX;
    /// Also what the maps would take as quadtrees, each by itself.
    bool count_quadtrees = false;
};

/// An octree and what it is the octree of: tree.levels = shape.levels(), children as StackShape says.
struct StackTree {
    StackShape shape;
    MultiresTree tree;
};

/// One anisotropy that was tried.
struct StackTrial {
    int anisotropy = 0;
    bool given_up = false;    ///< it got too large
    std::uint64_t bytes = 0;  ///< of its nodes, without padding
    friend bool operator==(const StackTrial&, const StackTrial&) = default;
};

/// Counts of a construction, the same for any exec.
struct StackTreeStats {
    std::vector<StackTrial> trials;
    MultiresCounts quadtrees;          ///< all maps' together, where asked for
    std::uint64_t certain_groups = 0;  ///< all maps' together
};

/// Bytes of nodes by the layouts of trees and stacks in words of 32 bits: 4 a leaf or an empty node, 8 a full
/// one.
constexpr std::uint64_t word_bytes(const MultiresCounts& counts) {
    return 4 * (counts.leaf + counts.empty + 2 * counts.full);
}

/// The octree of `slices` (>= 1) maps of 2^map_levels texels a side; `slice(k)` makes map k, is called from
/// several threads at once, and once for each k. Maps behind the last, to a power of two, take any depth.
/// Equal to the bottom-up construction over all texels, for any exec; memory follows the octree and O(log
/// slices) maps. Levels above max_tree_levels are a LimitError. When `cancel` is set meanwhile, the result
/// has no meaning.
StackTree build_stack_tree(int slices, int map_levels, const std::function<CertainTree(int)>& slice,
                           const StackTreeParams& params, const Exec& exec, StackTreeStats* stats = nullptr,
                           const std::atomic<bool>* cancel = nullptr);

}  // namespace obscura
