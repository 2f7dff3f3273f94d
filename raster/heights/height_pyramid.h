#pragma once
// The greatest height of blocks of a grid, in levels, so that a ray passes over low ground in long steps.

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "raster/heights/height_field.h"

namespace obscura {

/// Level k >= 1 has a value for each block of 8^k x 8^k cells: the greatest height of the samples at their
/// corners. Levels end where one block is the whole grid. Needs a field of 2 x 2 samples or more.
struct HeightPyramid {
    static constexpr int step_bits = 3;
    std::vector<Image<std::int32_t>> levels;  ///< levels[k - 1], in 1/65536 m

    int top() const { return static_cast<int>(levels.size()); }
    std::int32_t greatest_q16(int level, int cell_x, int cell_y) const {
        return levels[static_cast<std::size_t>(level - 1)](cell_x >> (step_bits * level),
                                                           cell_y >> (step_bits * level));
    }
};

HeightPyramid height_pyramid(const HeightField& field);

}  // namespace obscura
