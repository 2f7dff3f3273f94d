#pragma once
// Depths as 32-bit whole numbers, which add without rounding. POD: kernels include this.
//
// A relative tree gets its depths back by adding along the way. Floats do not do that: b + (z - b) != z for
// one pair of random depths in six. Whole numbers modulo 2^32 do, so the sum of a way is the number that the
// node was given, whatever the way.
//
// fractions:  v stands for v / 2^32, rounded to the nearest float (0xffffffff: 1).
// float_bits: v is the bits of the float, which are ordered as depths are.
//
// Rounding is monotone and keeps floats, so of an interval of floats every fraction from ceil(entry 2^32) to
// floor(exit 2^32) becomes a float inside it, and so do those that round to its ends: 256 fractions for a
// depth in [1/2, 1), two for one in [2^-8, 2^-7), one in [2^-9, 2^-8). Below that, depths stand closer than
// fractions do, and an interval may hold none: then float bits serve, for the whole tree.

#include <cstdint>

#include "hierarchy/tree_code.h"

namespace obscura {

/// v / 2^32, rounded once: both halves are exact floats.
OBSCURA_TREE_INLINE float depth_of_fraction(std::uint32_t v) {
    return static_cast<float>(v >> 16) * 0x1p-16f + static_cast<float>(v & 0xffffu) * 0x1p-32f;
}

OBSCURA_TREE_INLINE float depth_of_bits(std::uint32_t v) {
    float depth;
    __builtin_memcpy(&depth, &v, sizeof depth);
    return depth;
}

/// Of the mmh layouts.
OBSCURA_TREE_INLINE float depth_of_fixed(TreeLayout layout, std::uint32_t v) {
    return layout == TreeLayout::float_bits ? depth_of_bits(v) : depth_of_fraction(v);
}

}  // namespace obscura
