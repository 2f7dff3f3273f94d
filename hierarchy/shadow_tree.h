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
    MultiresCounts counts;
    TreeCode code;                    ///< points into `bits` and `top`
    std::uint64_t bytes = 0;          ///< of the serialised nodes, padding included
    std::uint64_t padding_bytes = 0;  ///< of these, for alignment to the offsets' units
    std::shared_ptr<const void> bits;
    std::shared_ptr<const std::vector<TopNode>> top;
};

struct EncodeParams {
    TreeLayout layout = TreeLayout::words24;
    int top_levels = 0;   ///< levels in the dense top grid, in [0, levels]; 0: no grid
    int offset_bits = 0;  ///< fewer bits for offsets than the layout has, for tests; 0: all of them
};

/// Serialises a quadtree. When a layout's offsets cannot reach at a bearable loss to padding, the next wider
/// one is taken (see the tree's code.layout). Throws LimitError beyond what a unit index can name.
ShadowTree encode_tree(const MultiresTree& tree, const LightView& view, const EncodeParams& params = {});

}  // namespace obscura
