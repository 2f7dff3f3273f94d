#pragma once
// Morton codes (G. M. Morton, IBM 1966): the bits of coordinates in turns, so that what is near in the code
// is near in the plane or in space.

#include <cstdint>

namespace obscura {

/// In the plane: bits of x in the even places. x, y < 2^bits; fewer bits take fewer steps.
template <int bits = 32>
constexpr std::uint64_t morton_code(std::uint32_t x, std::uint32_t y) {
    const auto spread = [](std::uint64_t v) {
        if constexpr (bits > 16) v = (v | v << 16) & 0x0000ffff0000ffffu;
        if constexpr (bits > 8) v = (v | v << 8) & 0x00ff00ff00ff00ffu;
        v = (v | v << 4) & 0x0f0f0f0f0f0f0f0fu;
        v = (v | v << 2) & 0x3333333333333333u;
        return (v | v << 1) & 0x5555555555555555u;
    };
    return spread(x) | spread(y) << 1;
}

/// In space: x, y, z < 2^10, bits of x lowest.
constexpr std::uint32_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const auto spread = [](std::uint32_t v) {
        v = (v | v << 16) & 0x030000ffu;
        v = (v | v << 8) & 0x0300f00fu;
        v = (v | v << 4) & 0x030c30c3u;
        return (v | v << 2) & 0x09249249u;
    };
    return spread(x) | spread(y) << 1 | spread(z) << 2;
}

}  // namespace obscura
