#pragma once
// Which fine rows make a coarse row, and the other way round (restrict_row, prolong_row in grid_rows.h).

#include <algorithm>

#include "stereo/solver/grid_rows.h"

namespace obscura {

/// The four fine rows y = 2 Y - 1 ... 2 Y + 2 that coarse row Y gathers, of a grid `height` rows high; row(y)
/// gives a row. Borders keep what they would give to a neighbour outside: the row counts twice. `zeros` is
/// a row of zeros.
template <class Row>
void restrict_sources(int Y, int height, const float* zeros, Row&& row, const float* (&out)[4]) {
    out[0] = row(std::max(2 * Y - 1, 0));
    out[1] = row(2 * Y);
    out[2] = 2 * Y + 1 < height ? row(2 * Y + 1) : zeros;
    out[3] = 2 * Y + 2 < height ? row(2 * Y + 2) : (2 * Y + 2 == height ? row(height - 1) : zeros);
}

/// The coarse row besides its own, y / 2, that fine row y is interpolated from.
inline int other_coarse_row(int y, int coarse_height) {
    return std::clamp(y / 2 + (y % 2 == 0 ? -1 : 1), 0, coarse_height - 1);
}

}  // namespace obscura
