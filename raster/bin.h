#pragma once
// Sorts records into square tiles: count, prefix sum, scatter. Lists come out in ascending record order,
// whatever the thread count.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/buffer.h"
#include "core/isa.h"
#include "raster/setup.h"

namespace obscura {

/// Lists of record indices, tile by tile, row-major. Tile 0 begins at the corner of the region.
struct TileBins {
    Region region;
    int tile = 64;  ///< side in texels
    int columns = 0, rows = 0;
    Buffer<std::uint32_t> first;  ///< columns * rows + 1 offsets into `items`
    Buffer<std::uint32_t> items;
    Buffer<std::uint32_t> counts;  ///< scratch: per chunk and tile

    std::size_t tiles() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    std::span<const std::uint32_t> list(std::size_t i) const {
        return {items.data() + first[i], first[i + 1] - first[i]};
    }
    std::span<const std::uint32_t> list(int column, int row) const { return list(index(column, row)); }
    /// The whole tile, in the view's texels; at the far borders it may reach past the region.
    TileRect rect(std::size_t i) const {
        const auto at = static_cast<int>(i);
        return {region.x0 + at % columns * tile, region.y0 + at / columns * tile, tile, tile};
    }
    /// How much of that lies in the region.
    Region inside(std::size_t i) const {
        const TileRect r = rect(i);
        return {r.x0, r.y0, std::min(tile, region.x0 + region.width - r.x0),
                std::min(tile, region.y0 + region.height - r.y0)};
    }
};

/// Bins every record (of a pair the first) that may touch a sample of a tile of `region`. `tile` is a power
/// of two. Throws LimitError when the lists would pass 2^32 entries.
void bin_records(const TriangleSetup& setup, const Region& region, int tile, const Exec& exec,
                 TileBins& bins);

}  // namespace obscura
