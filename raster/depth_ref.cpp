// Nearest depth of every sample of a tile: every triangle, every sample, the definition.

#include "raster/coverage.h"
#include "raster/depth_tile.h"

namespace obscura::ref {
namespace {

/// Calls fn(offset, depth) for every sample of the tile that the triangle or pair at t covers.
template <class Fn>
void for_each_sample(const TriangleRecord& t, const TileRect& tile, Fn&& fn) {
    for (std::int32_t y = 0; y < tile.height; ++y) {
        for (std::int32_t x = 0; x < tile.width; ++x) {
            if (!covers_outline(&t, tile.x0 + x, tile.y0 + y, tile.sample_x, tile.sample_y)) continue;
            const double X = sample_position(tile.x0 + x, tile.sample_x);
            const double Y = sample_position(tile.y0 + y, tile.sample_y);
            fn(y * tile.width + x, depth_at(t, X, Y));
        }
    }
}

}  // namespace

void depth_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                const TileRect& tile, float* depth) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        for_each_sample(records[list[i]], tile, [&](std::int32_t at, float z) {
            if (z < depth[at]) depth[at] = z;
        });
    }
}

void visibility_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                     const TileRect& tile, float* depth, std::uint32_t* triangle) noexcept {
    // Lists are in ascending order of triangle, so "strictly nearer" keeps the least index at equal depths.
    for (std::size_t i = 0; i < count; ++i) {
        const TriangleRecord& t = records[list[i]];
        for_each_sample(t, tile, [&](std::int32_t at, float z) {
            if (!(z < depth[at])) return;
            depth[at] = z;
            triangle[at] = t.triangle;
        });
    }
}

}  // namespace obscura::ref
