// All crossings of a tile, one sample at a time: insertion into a sorted list of eight, the rest spills.

#include <algorithm>
#include <utility>

#include "raster/coverage.h"
#include "raster/intervals.h"
#include "raster/layer_tile.h"

namespace obscura::ref {
namespace {

/// Inserts one crossing into the sorted layers of a texel.
void insert(LayerStack& stack, std::int32_t texel, LayerKey key, std::uint32_t triangle) {
    // A row of sixteen gets a new layer of empty places when one of its texels needs it.
    std::int32_t& filled = stack.filled[texel / 16];
    for (int l = 0; l < filled; ++l) {
        LayerKey& place = stack.keys[layer_place(texel, l)];
        if (stack.triangles == nullptr) {
            if (key < place) std::swap(key, place);
        } else {
            std::int32_t& id = stack.triangles[layer_place(texel, l)];
            if (std::pair(key, triangle) < std::pair(place, static_cast<std::uint32_t>(id))) {
                std::swap(key, place);
                triangle = static_cast<std::uint32_t>(std::exchange(id, static_cast<std::int32_t>(triangle)));
            }
        }
        if (key == no_layer) return;
    }
    if (filled == layers_in_place) {
        if (stack.spill_count < stack.spill_capacity)
            stack.spilled[stack.spill_count] = {texel, key, triangle};
        ++stack.spill_count;
        return;
    }
    const std::int32_t row = texel / 16 * 16;
    std::fill_n(stack.keys + layer_place(row, filled), 16, no_layer);
    stack.keys[layer_place(texel, filled)] = key;
    if (stack.triangles != nullptr) {
        std::fill_n(stack.triangles + layer_place(row, filled), 16, 0);
        stack.triangles[layer_place(texel, filled)] = static_cast<std::int32_t>(triangle);
    }
    ++filled;
}

}  // namespace

void layer_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                const TileRect& tile, LayerStack& stack) noexcept {
    std::fill_n(stack.filled, tile.width * tile.height / 16, 0);
    stack.spill_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const TriangleRecord& t = records[list[i]];
        for (std::int32_t y = 0; y < tile.height; ++y) {
            for (std::int32_t x = 0; x < tile.width; ++x) {
                if (!covers(t, tile.x0 + x, tile.y0 + y, tile.sample_x, tile.sample_y)) continue;
                const float z = depth_at(t, sample_position(tile.x0 + x, tile.sample_x),
                                         sample_position(tile.y0 + y, tile.sample_y));
                insert(stack, y * tile.width + x, layer_key(z, t.crossing), t.triangle);
            }
        }
    }
}

void layer_tile_with_triangles(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                               const TileRect& tile, LayerStack& stack) noexcept {
    layer_tile(records, list, count, tile, stack);
}

void interval_tile(const LayerStack& stack, const TileRect& tile, bool static_receivers,
                   DepthInterval* out) noexcept {
    const Receivers receivers = static_receivers ? Receivers::static_only : Receivers::any;
    for (std::int32_t i = 0; i < tile.width * tile.height; ++i) {
        LayerCrossing crossings[layers_in_place];
        std::size_t n = 0;
        while (static_cast<std::int32_t>(n) < stack.filled[i / 16]) {
            const LayerKey key = stack.keys[layer_place(i, static_cast<std::int32_t>(n))];
            if (key == no_layer) break;
            crossings[n++] = {layer_depth(key), layer_crossing(key), 0};
        }
        // Eight layers may hide a ninth.
        const bool more = n == layers_in_place;
        out[i] = more && !interval_decided({crossings, n}, receivers)
                     ? DepthInterval{undecided_entry, 0.0f}
                     : interval_of({crossings, n}, receivers);
    }
}

}  // namespace obscura::ref
