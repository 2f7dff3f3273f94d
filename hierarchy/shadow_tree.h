#pragma once
// An encoded shadow map: the tree's bits, the light view it was made for, and its counts.

#include <cstdint>
#include <memory>
#include <vector>

#include "core/types.h"
#include "hierarchy/multires.h"
#include "hierarchy/tree_code.h"

namespace obscura {

/// Immutable and cheap to copy: copies share the bits, which live in memory or in a mapped file.
struct ShadowTree {
    LightView view;
    MultiresCounts counts;            ///< as count_nodes(): a tree of one node has a leaf
    TreeCode code;                    ///< points into `bits` and `top`
    std::uint64_t bytes = 0;          ///< of the serialised nodes, padding included
    std::uint64_t padding_bytes = 0;  ///< of these, for alignment to the offsets' units
    std::shared_ptr<const void> bits;
    std::shared_ptr<const std::vector<TopNode>> top;
};

struct EncodeParams {
    TreeLayout layout = TreeLayout::words24;
    int top_levels = 0;   ///< levels in the dense top grid, in [0, min(levels, max_top_levels)]; 0: no grid
    int offset_bits = 0;  ///< fewer bits for offsets, for tests, at least min_offset_bits; 0: the layout's
    double bearable_padding = 1.0 / 8;  ///< of the nodes' own bytes: beyond it the next wider layout is taken
    std::uint64_t max_units = std::uint64_t{1} << 31;  ///< of the result; less for tests
};

constexpr int min_offset_bits = 4;  ///< with fewer, four siblings cannot each reach their children

/// Serialises a quadtree, in time and memory O(nodes). When a layout's offsets cannot reach at a bearable
/// loss to padding, the next wider one is taken: bytes16, words16, words24 (see the tree's code.layout).
/// Throws LimitError when the tree has more than 2^31 words, which is what lookups can name. Padding is zero,
/// so equal trees give equal bytes.
ShadowTree encode_tree(const MultiresTree& tree, const LightView& view, const EncodeParams& params = {});

}  // namespace obscura
