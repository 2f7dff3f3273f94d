#pragma once
// A tile of a bit map as blocks of 8 x 8 samples.

#include <cstdint>
#include <vector>

#include "raster/heights/shadow_bits.h"

namespace obscura {

/// Samples [x, x + width) x [y, y + height) of a map; x is a multiple of 8.
struct TileArea {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const TileArea&, const TileArea&) = default;
};

/// Sample (x, y) of the tile is bit 8 (y mod 8) + x mod 8 of block (x / 8, y / 8).
struct TileBits {
    int blocks_x = 0, blocks_y = 0;
    std::vector<std::uint64_t> blocks;

    TileBits() = default;
    explicit TileBits(const TileArea& area)
        : blocks_x((area.width + 7) / 8),
          blocks_y((area.height + 7) / 8),
          blocks(static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y)) {}

    std::uint64_t& operator()(int x, int y) { return blocks[index(x, y)]; }
    std::uint64_t operator()(int x, int y) const { return blocks[index(x, y)]; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_x) + static_cast<std::size_t>(x);
    }
};

/// The map's bits; 0 beyond the area.
TileBits tile_of(const ShadowBits& map, const TileArea& area);

/// Sets the area's bits, whatever they were.
void put_tile(const TileBits& tile, const TileArea& area, ShadowBits& map);

}  // namespace obscura
