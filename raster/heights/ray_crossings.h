#pragma once
// What a ray to the sun passes over between two lines of a grid, in doubles.

#include <cstdint>

#include "raster/heights/sun_view.h"

namespace obscura {

/// A ray from a sample, line after line.
class RayCrossings {
  public:
    explicit RayCrossings(const SunView& view)
        : view_(view), slope_(static_cast<double>(view.slope_q20) / static_cast<double>(cell_q20)) {}

    /// Calls visit(t, height_m) for every edge that the ray from (line, row) passes over after its line d -
    /// 1, at the share t in [0, 1] of the way to line d, 1 <= d <= line. False when it has left the grid by
    /// then.
    template <class Visit>
    bool strip(int line, int row, int d, Visit&& visit) const {
        const std::int64_t y_q20 = view_.slope_q20 * (d - 1);
        const int r = row + static_cast<int>(y_q20 >> 20);
        const double y = static_cast<double>(y_q20 & (cell_q20 - 1)) / static_cast<double>(cell_q20);
        if (r >= view_.rows || (r == view_.rows - 1 && y > 0)) return false;
        cells(line - d, r, y, visit);
        return true;
    }

  private:
    double height_m(int line, int row) const { return metres_of(view_.height_q16(line, row)); }

    /// From line `there` + 1, y in [0, 1) beyond row r, to line `there`.
    template <class Visit>
    void cells(int there, int r, double y, Visit&& visit) const {
        const int here = there + 1;
        const auto edge = [&](double t, double a, double b, double share) { visit(t, a + (b - a) * share); };
        const double end = y + slope_;
        if (r + 1 >= view_.rows) {
            // Along the last row.
            if (slope_ == 0) visit(1.0, height_m(there, r));
            return;
        }
        if (view_.crossed_diagonals) {
            const double t = (1 - y) / (1 + slope_), v = y + slope_ * t;
            edge(t, height_m(there, r), height_m(here, r + 1), v);
        } else if (slope_ < 1 && y <= 1 - slope_) {
            const double t = y / (1 - slope_);
            edge(t, height_m(here, r), height_m(there, r + 1), t);
        }
        if (end < 1) {
            edge(1, height_m(there, r), height_m(there, r + 1), end);
            return;
        }
        // Over the next row, and if there is one, into the cell beyond.
        const double t = (1 - y) / slope_;
        edge(t, height_m(here, r + 1), height_m(there, r + 1), t);
        if (r + 2 >= view_.rows) return;
        if (view_.crossed_diagonals) {
            const double at = (2 - y) / (1 + slope_), v = y - 1 + slope_ * at;
            edge(at, height_m(there, r + 1), height_m(here, r + 2), v);
        }
        edge(1, height_m(there, r + 1), height_m(there, r + 2), end - 1);
    }

    const SunView& view_;
    double slope_;
};

}  // namespace obscura
