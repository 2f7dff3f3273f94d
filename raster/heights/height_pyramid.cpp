#include "raster/heights/height_pyramid.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace obscura {
namespace {

constexpr int block = 1 << HeightPyramid::step_bits;

Image<std::int32_t> lowest(int cells_x, int cells_y) {
    Image<std::int32_t> level((cells_x + block - 1) / block, (cells_y + block - 1) / block);
    std::fill(level.pixels.begin(), level.pixels.end(), std::numeric_limits<std::int32_t>::min());
    return level;
}

}  // namespace

HeightPyramid height_pyramid(const HeightField& field) {
    check_height_field(field);
    const int cells_x = field.width() - 1, cells_y = field.height() - 1;
    CHECK(cells_x >= 1 && cells_y >= 1);
    HeightPyramid pyramid;
    Image<std::int32_t> first = lowest(cells_x, cells_y);
    // A sample on the border of blocks is a corner of cells in all of them.
    for (int y = 0; y <= cells_y; ++y) {
        for (int x = 0; x <= cells_x; ++x) {
            for (int j = std::max(y - 1, 0) / block; j <= std::min(y, cells_y - 1) / block; ++j) {
                for (int i = std::max(x - 1, 0) / block; i <= std::min(x, cells_x - 1) / block; ++i)
                    first(i, j) = std::max(first(i, j), field.height_q16(x, y));
            }
        }
    }
    pyramid.levels.push_back(std::move(first));
    while (std::max(pyramid.levels.back().width, pyramid.levels.back().height) > 1) {
        const Image<std::int32_t>& below = pyramid.levels.back();
        Image<std::int32_t> above = lowest(below.width, below.height);
        for (int y = 0; y < below.height; ++y) {
            for (int x = 0; x < below.width; ++x) {
                std::int32_t& to = above(x / block, y / block);
                to = std::max(to, below(x, y));
            }
        }
        pyramid.levels.push_back(std::move(above));
    }
    return pyramid;
}

}  // namespace obscura
