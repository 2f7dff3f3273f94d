#include "hierarchy/terrain/tile_bits.h"

#include "core/error.h"

namespace obscura {
namespace {

/// Bits [x, x + 8) of a row of words; x is a multiple of 8.
std::uint64_t byte_at(const std::uint64_t* row, int x) {
    return row[x >> 6] >> (x & 63) & 0xff;
}

std::uint64_t mask_of(int bits) {
    return bits >= 8 ? 0xff : (std::uint64_t{1} << bits) - 1;
}

void check_area(const ShadowBits& map, const TileArea& area) {
    CHECK(area.x >= 0 && area.y >= 0 && area.x % 8 == 0 && area.width > 0 && area.height > 0);
    CHECK(area.x + area.width <= map.width && area.y + area.height <= map.height);
}

}  // namespace

TileBits tile_of(const ShadowBits& map, const TileArea& area) {
    check_area(map, area);
    TileBits tile(area);
    for (int y = 0; y < area.height; ++y) {
        const std::uint64_t* row = map.row(area.y + y);
        for (int b = 0; b < tile.blocks_x; ++b) {
            const std::uint64_t bits = byte_at(row, area.x + 8 * b) & mask_of(area.width - 8 * b);
            tile(b, y / 8) |= bits << (8 * (y % 8));
        }
    }
    return tile;
}

void put_tile(const TileBits& tile, const TileArea& area, ShadowBits& map) {
    check_area(map, area);
    for (int y = 0; y < area.height; ++y) {
        std::uint64_t* row = map.row(area.y + y);
        for (int b = 0; b < tile.blocks_x; ++b) {
            const int x = area.x + 8 * b;
            const std::uint64_t mask = mask_of(area.width - 8 * b);
            const std::uint64_t bits = tile(b, y / 8) >> (8 * (y % 8)) & mask;
            row[x >> 6] = (row[x >> 6] & ~(mask << (x & 63))) | bits << (x & 63);
        }
    }
}

}  // namespace obscura
