// All crossings of a tile, one sample at a time: insertion into sorted lists that grow as they need.

#include <algorithm>
#include <utility>
#include <vector>

#include "raster/coverage.h"
#include "raster/intervals.h"
#include "raster/layer_tile.h"

namespace obscura::ref {
namespace {

/// Empties the lists of a tile; each row of sixteen gets room for eight layers.
void begin_tile(const TileRect& tile, LayerStack& stack) {
    const std::int32_t rows = tile.width * tile.height / 16;
    for (std::int32_t r = 0; r < rows; ++r) {
        stack.first[r] = r * layers_in_place;
        stack.room[r] = layers_in_place;
        stack.filled[r] = 0;
    }
    stack.used = rows * layers_in_place;
    stack.overflow = false;
}

/// Adds an empty layer to a row; a full row moves to twice the room. False when there is none left.
bool add_layer(LayerStack& stack, std::int32_t row) {
    if (stack.filled[row] == stack.room[row]) {
        const std::int32_t room = 2 * stack.room[row];
        if (stack.used + room > stack.capacity) return false;
        const std::int32_t from = stack.place(row, 0), to = stack.used * 16, count = stack.filled[row] * 16;
        std::copy_n(stack.keys + from, count, stack.keys + to);
        if (stack.triangles != nullptr) std::copy_n(stack.triangles + from, count, stack.triangles + to);
        stack.first[row] = stack.used;
        stack.room[row] = room;
        stack.used += room;
    }
    const std::int32_t at = stack.place(row, stack.filled[row]++);
    std::fill_n(stack.keys + at, 16, no_layer);
    if (stack.triangles != nullptr) std::fill_n(stack.triangles + at, 16, 0);
    return true;
}

/// Inserts one crossing into the sorted layers of a texel.
void insert(LayerStack& stack, std::int32_t texel, LayerKey key, std::uint32_t triangle) {
    const std::int32_t row = texel / 16, lane = texel % 16;
    const std::int32_t last = stack.filled[row] - 1;
    if (last < 0 || stack.keys[stack.place(row, last) + lane] != no_layer) {
        if (!add_layer(stack, row)) {
            stack.overflow = true;
            return;
        }
    }
    for (std::int32_t l = 0; l < stack.filled[row]; ++l) {
        const std::int32_t at = stack.place(row, l) + lane;
        if (stack.triangles == nullptr) {
            if (key < stack.keys[at]) std::swap(key, stack.keys[at]);
            continue;
        }
        const auto other = static_cast<std::uint32_t>(stack.triangles[at]);
        if (std::pair(key, triangle) < std::pair(stack.keys[at], other)) {
            std::swap(key, stack.keys[at]);
            stack.triangles[at] = static_cast<std::int32_t>(triangle);
            triangle = other;
        }
    }
}

}  // namespace

void layer_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                const TileRect& tile, LayerStack& stack) noexcept {
    begin_tile(tile, stack);
    for (std::size_t i = 0; i < count; ++i) {
        const TriangleRecord& t = records[list[i]];
        for (std::int32_t y = 0; y < tile.height; ++y) {
            for (std::int32_t x = 0; x < tile.width; ++x) {
                if (!covers_outline(&t, tile.x0 + x, tile.y0 + y, tile.sample_x, tile.sample_y)) continue;
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
    std::vector<LayerCrossing> crossings;
    for (std::int32_t i = 0; i < tile.width * tile.height; ++i) {
        crossings.clear();
        for (std::int32_t l = 0; l < stack.filled[i / 16]; ++l) {
            const LayerKey key = stack.keys[stack.place(i / 16, l) + i % 16];
            if (key == no_layer) break;
            crossings.push_back({layer_depth(key), layer_crossing(key), 0});
        }
        out[i] = crossings.empty() ? DepthInterval{} : interval_of(crossings, receivers);
    }
}

}  // namespace obscura::ref
