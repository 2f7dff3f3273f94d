#pragma once
// The serialised octree of a stack as lookups read it. POD: kernels include this.
//
// Scandolo, Bauszat, Eisemann 2016, section 4: as hierarchy/tree_code.h, with eight children, so that the
// kinds of children take 16 bits and a header of 16 + 16 bits needs no padding.
//
//   header   bits 0-15: kinds of the eight children (ChildKind, two bits each); above: offset
//   full     header, value        empty    header        leaf    value
//
// `narrow` headers are one word of 32 bits, with 16 bits of offset: full nodes take two words, empty nodes
// and leaves one, and the words of the siblings before child i are the bits set below bit 2i. `wide` ones are
// two words, with 31 bits of offset, for trees whose offsets do not reach: full, empty, leaf take 3, 2 and 1
// words, the kinds' own numbers.

#include <cstdint>

#include "hierarchy/stack/stack_shape.h"
#include "hierarchy/tree_code.h"

namespace obscura {

enum class StackLayout : std::uint32_t { narrow = 0, wide = 1 };

/// What a lookup needs of an octree. The root stands at word 0 and is always a full node, even without
/// children. children(node at height h) = node + offset * offset_scale[h].
struct StackCode {
    const std::uint32_t* words = nullptr;
    StackLayout layout = StackLayout::narrow;
    StackShape shape;
    std::uint32_t offset_scale[max_tree_levels + 1] = {};
};

}  // namespace obscura
