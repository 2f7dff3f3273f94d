#pragma once
// Lookups in a serialised tree. POD: kernels include this.
//
// Scandolo, Bauszat, Eisemann 2016, section 3.2, traversal. Lookups take texels of the map and may stop at a
// level: at level l they see the map of (2^levels >> l) squares a side that the tree's nodes down to height l
// describe, and answer with the value of the square that holds the texel. Level 0 is the map itself.

#include <cstddef>
#include <cstdint>

#include "hierarchy/tree_code.h"

namespace obscura {

/// Texels and the depths that ask for light there, one array per coordinate. Any texel may be named.
struct MapPoints {
    const std::int32_t* x = nullptr;
    const std::int32_t* y = nullptr;
    const float* depth = nullptr;
    std::size_t count = 0;
};

/// stored_values: value[i] of texel (x[i], y[i]), which must lie inside the map.
/// visibility: bit i % 16 of lit[i / 16] tells whether point i is lit: depth <= stored value, or outside the
/// map. The (count + 15) / 16 words of `lit` are written whole, with zeros beyond the last point.
/// coherent_visibility: the same result. Faster where each 16 points that stand together are neighbours, say
/// 4 x 4 pixels: they go down together to their lowest common node, from that of the 16 points before.
/// `level` is in [0, levels].
#define OBSCURA_TREE_QUERIES                                                                                \
    void stored_values(const TreeCode& tree, const std::int32_t* x, const std::int32_t* y,                  \
                       std::size_t count, int level, float* value) noexcept;                                \
    void visibility(const TreeCode& tree, const MapPoints& points, int level, std::uint16_t* lit) noexcept; \
    void coherent_visibility(const TreeCode& tree, const MapPoints& points, int level,                      \
                             std::uint16_t* lit) noexcept;
namespace ref {
OBSCURA_TREE_QUERIES
}
namespace sse2 {
OBSCURA_TREE_QUERIES
}
namespace avx2 {
OBSCURA_TREE_QUERIES
}
namespace avx512bw {
OBSCURA_TREE_QUERIES
}
#undef OBSCURA_TREE_QUERIES

}  // namespace obscura
