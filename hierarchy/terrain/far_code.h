#pragma once
// The code of far maps: some maps of one tile, sun after sun, as few bytes that decode by themselves.

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/terrain/tile_bits.h"

namespace obscura {

/// Codes `maps` of one tile in their order. Where a bit of `cares`, as many and as large, is 0, any bit may
/// come back: whichever is cheaper is taken. Lossless elsewhere. An empty result stands for maps without a
/// bit set.
std::vector<std::uint8_t> encode_far_tile(const std::vector<TileBits>& maps,
                                          const std::vector<TileBits>& cares);

/// `count` maps of a tile of this area. Any bytes decode to something: files know by hashes that they are
/// whole.
std::vector<TileBits> decode_far_tile(std::span<const std::uint8_t> bytes, const TileArea& area, int count);

}  // namespace obscura
