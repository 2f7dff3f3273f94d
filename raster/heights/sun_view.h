#pragma once
// A height field as one sun sees it: lines counted from the sun, rows in the direction in which rays to the
// sun drift.

#include <cstddef>
#include <cstdint>

#include "raster/heights/height_field.h"
#include "raster/heights/height_sun.h"

namespace obscura {

/// Sample (line, row): line 0 is the outermost on the sun's side. A ray to the sun goes from (line, row) by
/// way of (line - 1, row + slope) and so on, and each line higher by `rise`. Every sun of every grid looks
/// like this, so turned and mirrored grids give turned and mirrored maps, bit for bit.
struct SunView {
    const std::int32_t* first = nullptr;  ///< sample (0, 0)
    std::ptrdiff_t step_line = 0, step_row = 0;
    int lines = 0, rows = 0;
    /// Cells are divided from (line - 1, row) to (line, row + 1), of the two ways the one that a ray crosses;
    /// else from (line, row) to (line - 1, row + 1).
    bool crossed_diagonals = false;
    std::int64_t slope_q20 = 0, rise_q36 = 1;
    std::int32_t greatest_q16 = 0;  ///< of all heights

    std::int32_t height_q16(int line, int row) const { return first[line * step_line + row * step_row]; }
};

/// Where a sample of the view stands in the grid.
struct GridPlace {
    int x = 0, y = 0;
};
GridPlace place_of(const HeightField& field, const HeightSun& sun, int line, int row);

/// Looks at `field`, which has to live as long.
SunView sun_view(const HeightField& field, const HeightSun& sun);

}  // namespace obscura
