#pragma once
// Intervals of a block of 8 x 8 texels from a short list of facets (ref, sse2, avx2, avx512bw).
//
// The list is short, so crossings are not sorted: with the entries e_i and exits x_i of a ray, the counter is
// back at zero after exit x_j when not more e_i <= x_j than x_i <= x_j are there, and the first such exit
// ends the interval.

#include <cstddef>
#include <cstdint>

#include "raster/record.h"

namespace obscura {

constexpr int block_side = 8;
constexpr int block_texels = block_side * block_side;
constexpr int block_facets = 32;  ///< longest list

/// Texel of place i in a block, in Morton order: sixteen by sixteen, four by four.
constexpr int block_column(int i) {
    return (i & 1) | (i >> 1 & 2) | (i >> 2 & 4);
}
constexpr int block_row(int i) {
    return block_column(i >> 1);
}

/// Intervals of the texels [x0, x0 + 8) x [y0, y0 + 8) as `entry` and `exit`, 64 each in Morton order, from
/// at most block_facets records (or pairs); see raster/intervals.h for what an interval is.
#define OBSCURA_BLOCK_INTERVALS                                                                       \
    void block_intervals(const TriangleRecord* records, const std::uint32_t* list, std::size_t count, \
                         std::int32_t x0, std::int32_t y0, bool static_receivers, float* entry,       \
                         float* exit) noexcept;
namespace ref {
OBSCURA_BLOCK_INTERVALS
}
namespace sse2 {
OBSCURA_BLOCK_INTERVALS
}
namespace avx2 {
OBSCURA_BLOCK_INTERVALS
}
namespace avx512bw {
OBSCURA_BLOCK_INTERVALS
}
#undef OBSCURA_BLOCK_INTERVALS

}  // namespace obscura
