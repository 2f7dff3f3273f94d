#pragma once
// All crossings of a tile's rays in order, and their intervals (ref, sse2, avx2, avx512bw): a k-buffer of
// eight sorted layers per texel in place, with a list for what spills beyond.
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

/// A crossing that found no place in its texel's eight layers.
struct SpilledLayer {
    std::int32_t texel;  ///< row * width + column in the tile
    LayerKey key;
    std::uint32_t triangle;
};

/// Where layer l of texel i lies in LayerStack::keys: the layers of sixteen texels stand together, so that a
/// walk down the layers stays within a few neighbouring cache lines.
constexpr std::int32_t layer_place(std::int32_t texel, std::int32_t layer) {
    return (texel / 16 * layers_in_place + layer) * 16 + texel % 16;
}

/// Working memory of one tile. Rows of sixteen texels have filled[i / 16] layers, with no_layer where a texel
/// has fewer.
struct LayerStack {
    LayerKey* keys = nullptr;
    std::int32_t* triangles = nullptr;  ///< same places as keys; only where asked for
    std::int32_t* filled = nullptr;
    SpilledLayer* spilled = nullptr;
    std::size_t spill_capacity = 0;
    std::size_t spill_count = 0;  ///< may pass the capacity: then the tile must be run again with more room
};

/// Marks a texel whose eight layers did not decide its interval; its spilled layers must.
constexpr float undecided_entry = -1.0f;

/// layer_tile: keys only, or keys and triangles. Tiles are layer_tile_side square at most, width a multiple
/// of 16. interval_tile: out[i] from the keys in place; {undecided_entry, 0} where more than eight layers are
/// needed.
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
