#pragma once
// The eight corners of a cube, bit 0 of a corner's number its x, bit 1 y, bit 2 z, as six sides seen
// counter-clockwise from outside.

#include <cstdint>

namespace obscura {

constexpr std::uint32_t cube_quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

}  // namespace obscura
