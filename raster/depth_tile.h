#pragma once
// Nearest depth, and nearest depth with its triangle, over one tile (ref, sse2, avx2, avx512bw).

#include <cstddef>
#include <cstdint>

#include "raster/record.h"

namespace obscura {

/// Tiles are this wide and high at most.
constexpr int depth_tile_side = 64;
constexpr std::uint32_t no_triangle = 0xffffffffu;

/// depth_tile: depth[row * width + column] = least depth of the covered records and of what was there.
/// visibility_tile: also triangle[], the mesh triangle of that depth; at equal depths the least index.
/// `list` holds `count` indices into `records`.
#define OBSCURA_DEPTH_TILE                                                                            \
    void depth_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,      \
                    const TileRect& tile, float* depth) noexcept;                                     \
    void visibility_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count, \
                         const TileRect& tile, float* depth, std::uint32_t* triangle) noexcept;
namespace ref {
OBSCURA_DEPTH_TILE
}
namespace sse2 {
OBSCURA_DEPTH_TILE
}
namespace avx2 {
OBSCURA_DEPTH_TILE
}
namespace avx512bw {
OBSCURA_DEPTH_TILE
}
#undef OBSCURA_DEPTH_TILE

}  // namespace obscura
