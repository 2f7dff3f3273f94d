#pragma once
// Serialising the octree of a stack, and reading it back plainly.

#include <cstdint>

#include "hierarchy/stack/build_tree.h"
#include "hierarchy/stack/stack.h"

namespace obscura {

struct StackEncodeParams {
    StackLayout layout = StackLayout::narrow;
    int offset_bits = 0;                ///< fewer bits for offsets, for tests, at least 5; 0: the layout's
    double bearable_padding = 1.0 / 8;  ///< of the nodes' own bytes: beyond it the wide layout is taken
    std::uint64_t max_units = std::uint64_t{1} << 31;  ///< words of the result; less for tests
};

/// Fills in what a stack's lookups read: shape, counts, code, bytes. In time and memory O(nodes). Throws
/// LimitError when it has more words than lookups can name. Padding is zero, so equal octrees give equal
/// bytes.
void encode_stack(const StackTree& tree, const StackEncodeParams& params, ShadowStack& stack);

/// The octree that was encoded; the order of its nodes may differ, and the root's interval is its value
/// alone.
MultiresTree decode_stack(const ShadowStack& stack);

/// Value of texel (x, y) of map k, by descent from the root.
float stack_value(const StackCode& code, std::uint32_t x, std::uint32_t y, std::uint32_t k);

}  // namespace obscura
