#pragma once
// One step down a tree of the code facet (facet_format.h), and what its values are at a texel. POD: kernels
// include this.
//
// Nothing of a leaf is read on the way down, not even which side of its edge a texel is on: descents that end
// in a leaf end in the same place for all texels, and depth() does the rest.

#include <cstdint>

#include "hierarchy/facet/facet_format.h"
#include "hierarchy/tree_code.h"

namespace obscura {

/// TreePlace: count is the unit of the line that the descent ended in, or 0; inside its own sides.
struct FacetCode {
    static constexpr std::uint32_t unit_bytes = 4;
    static constexpr bool counts_values = true;
    static constexpr bool varies = true;

    static OBSCURA_TREE_INLINE std::uint32_t word(const TreeCode& tree, std::uint32_t at) {
        std::uint32_t word;
        __builtin_memcpy(&word, tree.units + static_cast<std::uint64_t>(at) * unit_bytes, sizeof word);
        return word;
    }
    static OBSCURA_TREE_INLINE FacetHeader header(const TreeCode& tree) {
        FacetHeader header;
        __builtin_memcpy(&header, tree.units, sizeof header);
        return header;
    }
    static OBSCURA_TREE_INLINE FacetEdge edge(const TreeCode& tree, std::uint32_t i) {
        const std::uint64_t at =
            std::uint64_t{header(tree).first_edge} + static_cast<std::uint64_t>(i) * facet_edge_words;
        FacetEdge edge;
        __builtin_memcpy(&edge, tree.units + at * unit_bytes, sizeof edge);
        return edge;
    }
    static OBSCURA_TREE_INLINE FacetPlane plane(const TreeCode& tree, std::uint32_t i) {
        const std::uint64_t at =
            std::uint64_t{header(tree).first_plane} + static_cast<std::uint64_t>(i) * facet_plane_words;
        FacetPlane plane;
        __builtin_memcpy(&plane, tree.units + at * unit_bytes, sizeof plane);
        return plane;
    }

    static OBSCURA_TREE_INLINE TreePlace root(const TreeCode&) {
        return {facet_header_words, facet_header_words + 1, 0, 0};
    }

    static OBSCURA_TREE_INLINE TreePlace child(const TreeCode& tree, TreePlace at, int height, std::int32_t x,
                                               std::int32_t y) {
        const std::uint32_t head = word(tree, at.node);
        // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): no descent goes below height 1
        const int bit = 3 * ((x >> (height - 1) & 1) + (y >> (height - 1) & 1) * 2);
        const std::uint32_t kind = head >> bit & 7u;
        const auto before = static_cast<std::uint32_t>(__builtin_popcount(head & ((1u << bit) - 1u)));
        const std::uint32_t node = at.node + (head >> facet_kind_bits) * tree.offset_scale[height] + before;
        if ((kind & facet_line) != 0) return {no_tree_node, at.value, node, kind & 3u};
        const std::uint32_t value = node + (kind >> 1);
        return {(kind & 2u) != 0 ? node : no_tree_node, (kind & 1u) != 0 ? value : at.value, 0, 0};
    }

    /// On which side of the line a texel is, and its value there.
    struct Side {
        std::uint32_t value = 0;  ///< unit
        double beyond = 0;        ///< see facet_offset()
    };
    static OBSCURA_TREE_INLINE Side side_of(const TreeCode& tree, TreePlace place, std::int32_t x,
                                            std::int32_t y) {
        if (place.count == 0) return {place.value, facet_far};
        const FacetEdge e = edge(tree, word(tree, place.count));
        const double distance = facet_distance(e, x, y), start = facet_ramp_start(e);
        const std::uint32_t low = place.inside >> 1, first = place.count + 1;
        if (distance >= 0) {
            return {(place.inside & facet_own_high) != 0 ? first + low : place.value, distance - start};
        }
        return {low != 0 ? first : place.value, -distance - start};
    }

    static OBSCURA_TREE_INLINE float depth(const TreeCode& tree, TreePlace place, std::int32_t x,
                                           std::int32_t y) {
        const Side side = side_of(tree, place, x, y);
        const std::uint32_t value = word(tree, side.value);
        if ((value & facet_is_plane) == 0) {
            float depth;
            __builtin_memcpy(&depth, &value, sizeof depth);
            return depth;
        }
        return facet_behind(facet_plane_depth(plane(tree, facet_plane_of(value)), x, y),
                            facet_offset(value, side.beyond));
    }
};

}  // namespace obscura
