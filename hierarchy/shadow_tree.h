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
    MultiresCounts counts;            ///< of the nodes that are stored; a tree of one node has a leaf
    TreeCode code;                    ///< points into `bits` and `top`
    std::uint64_t bytes = 0;          ///< of the serialised nodes, padding included
    std::uint64_t padding_bytes = 0;  ///< of these, for alignment to the offsets' units
    std::shared_ptr<const void> bits;
    std::shared_ptr<const std::vector<TopNode>> top;
};

/// Readable bytes behind the last unit: lookups fetch four bytes at any unit.
constexpr std::size_t tree_slack_bytes = 3;

}  // namespace obscura
