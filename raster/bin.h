#pragma once
// Sorts records into square tiles: count, prefix sum, scatter. Lists come out in ascending record order,
// whatever the thread count.

#include <cstdint>
#include <span>
#include <vector>

#include "core/buffer.h"
#include "core/isa.h"
#include "raster/setup.h"

namespace obscura {

/// Lists of record indices, tile by tile, row-major.
struct TileBins {
    int tile = 64;  ///< side in texels
    int columns = 0, rows = 0;
    Buffer<std::uint32_t> first;  ///< columns * rows + 1 offsets into `items`
    Buffer<std::uint32_t> items;
    Buffer<std::uint32_t> counts;  ///< scratch: per chunk and tile

    std::span<const std::uint32_t> list(int column, int row) const {
        const auto t = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                       static_cast<std::size_t>(column);
        return {items.data() + first[t], first[t + 1] - first[t]};
    }
};

/// Bins every record (of a pair the first) that may touch a sample of a tile of the width x height map.
/// `tile` is a power of two. Throws LimitError when the lists would pass 2^32 entries.
void bin_records(const TriangleSetup& setup, int width, int height, int tile, const Exec& exec,
                 TileBins& bins);

}  // namespace obscura
