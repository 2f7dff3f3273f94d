#pragma once
// A row of an outline's coverage, from the edges in it.

#include <algorithm>
#include <vector>

#include "optics/outline_coverage.h"

namespace obscura {

/// A side of a loop, top to bottom. Going right across it, the winding number grows by `winding`; level ones
/// join what they lie between, and count no more.
struct OutlineEdge {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int winding = 0;

    double at(double y) const {
        if (y <= y0) return x0;
        if (y >= y1) return x1;
        return x0 + (x1 - x0) * ((y - y0) / (y1 - y0));
    }
};

/// Collects one row of texels: differences[i] is how much more of texel i is open than of texel i - 1.
class RowAccumulator {
  public:
    explicit RowAccumulator(int width)
        : width_(width), differences_(static_cast<std::size_t>(width) + 2, 0.0) {}

    /// Opens (sign 1) or closes (sign -1) what lies right of a straight line from x = a down to x = b over
    /// `height` texels.
    void add(double a, double b, double height, double sign) {
        const double left = std::min(a, b), right = std::max(a, b);
        if (left >= width_ || !(height > 0)) return;
        if (right <= 0) {
            differences_[0] += sign * height;
            return;
        }
        const double per_x = right > left ? height / (right - left) : 0;
        if (left < 0) {
            differences_[0] += sign * per_x * -left;
            height -= per_x * -left;
        }
        double from = std::max(left, 0.0);
        auto texel = static_cast<int>(from);
        for (; texel < width_; ++texel) {
            const bool last = right <= texel + 1;
            const double to = last ? right : texel + 1;
            const double piece = last ? height : per_x * (to - from);
            put(texel, 0.5 * (from + to) - texel, sign * piece);
            height -= piece;
            from = to;
            if (last) return;
        }
    }

    int width() const { return width_; }

    void finish(float* row) {
        double sum = 0;
        for (int x = 0; x < width_; ++x) {
            sum += differences_[static_cast<std::size_t>(x)];
            row[x] = sum < 1e-9 ? 0.0f : static_cast<float>(std::min(sum, 1.0));
        }
        std::fill(differences_.begin(), differences_.end(), 0.0);
    }

  private:
    /// Area `amount` opens in whole texels from texel + 1 on; in `texel`, the share right of `where` of it.
    void put(int texel, double where, double amount) {
        const auto i = static_cast<std::size_t>(texel);
        differences_[i] += amount * (1 - where);
        differences_[i + 1] += amount * where;
    }

    int width_;
    std::vector<double> differences_;
};

/// Adds edges, of which only what lies in [top, top + 1] counts; they may cross, and are reordered. `winding`
/// is the number on their left, all along the row, as it is behind them, which is returned.
int add_edges(std::vector<OutlineEdge>& edges, double top, int winding, RowAccumulator& row,
              CoverageWork& work);

}  // namespace obscura
