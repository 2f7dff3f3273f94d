#pragma once
// One step down a merged tree (hierarchy/mmh/README.md). POD: kernels include this.
//
// L. Scandolo, P. Bauszat, E. Eisemann, "Merged Multiresolution Hierarchies for Shadow Map Compression",
// Pacific Graphics 2016, algorithm 1. Nodes are those of mh's words24; values are differences to the value
// above, so that what a descent carries is their sum. Unlike the paper's they are whole numbers
// (fixed_depth.h): their sums are exact.

#include <cstdint>

#include "hierarchy/fixed_depth.h"
#include "hierarchy/tree_code.h"

namespace obscura {

struct MmhCode {
    static constexpr std::uint32_t unit_bytes = 4;
    static constexpr std::uint32_t header = 1;
    static constexpr std::uint32_t low_bit = 1, high_bit = 1;  ///< units of a child, by the bits of its kind

    static OBSCURA_TREE_INLINE std::uint32_t word(const TreeCode& tree, std::uint32_t at) {
        std::uint32_t word;
        __builtin_memcpy(&word, tree.units + static_cast<std::uint64_t>(at) * unit_bytes, sizeof word);
        return word;
    }

    static constexpr bool counts_values = false;
    static constexpr bool varies = false;

    static OBSCURA_TREE_INLINE TreePlace root(const TreeCode& tree) { return {0, word(tree, header), 0, 0}; }

    static OBSCURA_TREE_INLINE TreePlace child(const TreeCode& tree, TreePlace at, int height, std::int32_t x,
                                               std::int32_t y) {
        const std::uint32_t head = word(tree, at.node);
        // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): no descent goes below height 1
        const int bit = (x >> (height - 1) & 1) * 2 + (y >> (height - 1) & 1) * 4;
        const std::uint32_t kind = head >> bit & 3u;
        const auto before = static_cast<std::uint32_t>(__builtin_popcount(head & ((1u << bit) - 1u)));
        const std::uint32_t node = at.node + (head >> 8) * tree.offset_scale[height] + before;
        if ((kind & 1u) != 0) at.value += word(tree, node + (kind >> 1) * header);
        return {(kind & 2u) != 0 ? node : no_tree_node, at.value, 0, 0};
    }

    static OBSCURA_TREE_INLINE float depth(const TreeCode& tree, TreePlace place) {
        return depth_of_fixed(tree.layout, place.value);
    }
};

}  // namespace obscura
