#pragma once
// One step down a tree of the code mh (hierarchy/tree_code.h). POD: kernels include this.
//
// Scandolo, Bauszat, Eisemann 2016, section 3.2, traversal with lazy fetching: only the place of the last
// value is carried, the value itself is read once.

#include <cstdint>

#include "hierarchy/tree_code.h"

namespace obscura {

/// What a layout's numbers are, in units (words or bytes).
template <TreeLayout layout>
struct MhCode {
    static constexpr bool bytes = row_of(layout).bytes;
    static constexpr std::uint32_t unit_bytes = bytes ? 1 : 4;
    static constexpr std::uint32_t header = bytes ? 3 : 1;
    static constexpr std::uint32_t low_bit = bytes ? 4 : 1, high_bit = bytes ? 3 : 1;  ///< of a child's kind
    static constexpr std::uint32_t offset_mask = (1u << row_of(layout).offset_bits) - 1;

    /// The word, or four bytes, at a unit.
    static OBSCURA_TREE_INLINE std::uint32_t word(const TreeCode& tree, std::uint32_t at) {
        std::uint32_t word;
        __builtin_memcpy(&word, tree.units + static_cast<std::uint64_t>(at) * unit_bytes, sizeof word);
        return word;
    }

    static constexpr bool counts_values = false;
    static constexpr bool varies = false;

    static OBSCURA_TREE_INLINE TreePlace root(const TreeCode&) { return {0, header, 0, 0}; }

    static OBSCURA_TREE_INLINE TreePlace child(const TreeCode& tree, TreePlace at, int height, std::int32_t x,
                                               std::int32_t y) {
        const std::uint32_t head = word(tree, at.node);
        // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): no descent goes below height 1
        const int bit = (x >> (height - 1) & 1) * 2 + (y >> (height - 1) & 1) * 4;
        const std::uint32_t kind = head >> bit & 3u;
        const std::uint32_t below = head & ((1u << bit) - 1u);
        const auto low = static_cast<std::uint32_t>(__builtin_popcount(below & 0x15u)),
                   high = static_cast<std::uint32_t>(__builtin_popcount(below & 0x2au));
        const std::uint32_t node =
            at.node + (head >> 8 & offset_mask) * tree.offset_scale[height] + low * low_bit + high * high_bit;
        // Kinds: low bit, it has a value; high bit, it has children, and a header before the value.
        const std::uint32_t value = node + (kind >> 1) * header;
        return {(kind & 2u) != 0 ? node : no_tree_node, (kind & 1u) != 0 ? value : at.value, 0, 0};
    }

    static OBSCURA_TREE_INLINE float depth(const TreeCode& tree, TreePlace place) {
        const std::uint32_t bits = word(tree, place.value);
        float value;
        __builtin_memcpy(&value, &bits, sizeof value);
        return value;
    }
};

/// Calls f(MhCode<layout>{}) for the tree's layout.
template <int row = tree_layout_count - 1, class F>
OBSCURA_TREE_INLINE auto with_mh_layout(const TreeCode& tree, F&& f) {
    constexpr TreeLayout layout = tree_layouts[row].layout;
    if constexpr (row > 0) {
        if (tree.layout != layout) return with_mh_layout<row - 1>(tree, f);
    }
    return f(MhCode<layout>{});
}

}  // namespace obscura
