#pragma once
// All crossings of a tile's rays in order, and their intervals (ref, sse2, avx2, avx512bw): a k-buffer of
// eight sorted layers per texel in place, which moves to twice the room when they are full.
//
// L. Bavoil et al., "Multi-Fragment Effects on the GPU using the k-Buffer", I3D 2007, for the buffer; ours
// never drops a fragment and needs no order of submission.

#include <cstddef>
#include <cstdint>

#include "core/types.h"
#include "raster/record.h"

namespace obscura {

constexpr int layers_in_place = 8;
constexpr int layer_tile_side = 64;
constexpr int layer_tile_texels = layer_tile_side * layer_tile_side;
constexpr int layer_tile_rows = layer_tile_texels / 16;  ///< rows of sixteen texels

/// Depth and kind of a crossing in one integer of the same order: bits of the depth (in [0, 1], below 2^30)
/// times four plus kind, moved to the signed range.
using LayerKey = std::int32_t;
constexpr LayerKey no_layer = INT32_MAX;
inline LayerKey layer_key(float depth, Crossing crossing) {
    std::uint32_t bits = 0;
    __builtin_memcpy(&bits, &depth, sizeof bits);
    return static_cast<LayerKey>(((bits << 2) | static_cast<std::uint32_t>(crossing)) ^ 0x80000000u);
}
inline float layer_depth(LayerKey key) {
    const std::uint32_t bits = (static_cast<std::uint32_t>(key) ^ 0x80000000u) >> 2;
    float depth = 0;
    __builtin_memcpy(&depth, &bits, sizeof depth);
    return depth;
}
inline Crossing layer_crossing(LayerKey key) {
    return static_cast<Crossing>(static_cast<std::uint32_t>(key) & 3u);
}

/// Working memory of one tile: the sorted layers of each row of sixteen texels, one under the other, so that
/// a walk through them stays within neighbouring cache lines. Layer l of lane i of row r is at place(r, l) +
/// i; lanes with fewer layers than their row end in no_layer.
struct LayerStack {
    LayerKey* keys = nullptr;           ///< `capacity` layers of sixteen
    std::int32_t* triangles = nullptr;  ///< same places as keys; only where asked for
    std::int32_t* first = nullptr;      ///< per row: where its layers begin, in layers
    std::int32_t* room = nullptr;       ///< per row: layers it may hold there
    std::int32_t* filled = nullptr;     ///< per row: layers it holds
    std::int32_t capacity = 0;
    std::int32_t used = 0;
    bool overflow = false;  ///< crossings were dropped: run the tile again with more capacity

    std::int32_t place(std::int32_t row, std::int32_t layer) const { return (first[row] + layer) * 16; }
};

/// layer_tile: keys only, or keys and triangles. Tiles are layer_tile_side square at most, width a multiple
/// of 16. interval_tile: out[row * width + column] from the keys.
#define OBSCURA_LAYER_TILE                                                                               \
    void layer_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,         \
                    const TileRect& tile, LayerStack& stack) noexcept;                                   \
    void layer_tile_with_triangles(const TriangleRecord* records, const std::uint32_t* list,             \
                                   std::size_t count, const TileRect& tile, LayerStack& stack) noexcept; \
    void interval_tile(const LayerStack& stack, const TileRect& tile, bool static_receivers,             \
                       DepthInterval* out) noexcept;
namespace ref {
OBSCURA_LAYER_TILE
}
namespace sse2 {
OBSCURA_LAYER_TILE
}
namespace avx2 {
OBSCURA_LAYER_TILE
}
namespace avx512bw {
OBSCURA_LAYER_TILE
}
#undef OBSCURA_LAYER_TILE

}  // namespace obscura
