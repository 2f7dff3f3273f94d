// The march of height_march_ref.cpp in doubles, line after line. A height above the ray that is nearer to 0
// than rounding can bring it is no answer, and if no other edge gives one, integers do.

#include "raster/heights/height_near.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "raster/heights/height_march.h"
#include "raster/heights/sun_view.h"

namespace obscura {
namespace {

/// Below any ray.
constexpr double lowest = -1e300;

class NearRays {
  public:
    NearRays(const HeightField& field, const HeightSun& sun, int last_line)
        : view_(sun_view(field, sun)),
          last_(last_line),
          slope_(static_cast<double>(view_.slope_q20) / static_cast<double>(cell_q20)),
          rise_m_(std::ldexp(static_cast<double>(view_.rise_q36), -rise_fraction_bits)),
          greatest_m_(metres_of(view_.greatest_q16)) {
        // Some twenty roundings of numbers of at most this size.
        doubt_m_ = std::ldexp(2 * largest_height_m + rise_m_ * std::min(last_, view_.lines), -46);
    }

    bool hidden(int line, int row) const {
        const std::optional<bool> answer = march(line, row);
        return answer ? *answer : sun_hidden(view_, line, row, {.first = 0, .last = last_});
    }

    const SunView& view() const { return view_; }

  private:
    double height_m(int line, int row) const { return metres_of(view_.height_q16(line, row)); }

    /// Nothing where doubles cannot tell.
    std::optional<bool> march(int line, int row) const {
        const double own_m = height_m(line, row);
        double highest = lowest;
        for (int d = 1; d <= std::min(last_, line); ++d) {
            const double ray_m = own_m + rise_m_ * (d - 1);
            if (ray_m - doubt_m_ > greatest_m_) break;
            const std::int64_t y_q20 = view_.slope_q20 * (d - 1);
            const int r = row + static_cast<int>(y_q20 >> 20);
            const double y = static_cast<double>(y_q20 & (cell_q20 - 1)) / static_cast<double>(cell_q20);
            if (r >= view_.rows || (r == view_.rows - 1 && y > 0)) break;
            highest = std::max(highest, strip(line - d, r, y, ray_m));
            if (highest > doubt_m_) return true;
        }
        if (highest >= -doubt_m_) return {};
        return false;
    }

    /// The greatest height above the ray from where it leaves line `there` + 1, `y` in [0, 1) beyond row r
    /// and at ray_m, to line `there`.
    double strip(int there, int r, double y, double ray_m) const {
        const int here = there + 1;
        const bool has_next = r + 1 < view_.rows, has_after = r + 2 < view_.rows;
        const auto above = [&](double t, double a, double b, double share) {
            return a + (b - a) * share - (ray_m + rise_m_ * t);
        };
        double most = lowest;
        const double end = y + slope_;
        if (!has_next) {
            // Along the last row.
            return slope_ == 0 ? above(1, height_m(there, r), 0, 0) : most;
        }
        if (view_.crossed_diagonals) {
            const double t = (1 - y) / (1 + slope_), v = y + slope_ * t;
            most = std::max(most, above(t, height_m(there, r), height_m(here, r + 1), v));
        } else if (slope_ < 1 && y <= 1 - slope_) {
            const double t = y / (1 - slope_);
            most = std::max(most, above(t, height_m(here, r), height_m(there, r + 1), t));
        }
        if (end < 1) return std::max(most, above(1, height_m(there, r), height_m(there, r + 1), end));
        // Over the next row, and if there is one, into the cell beyond.
        const double t = (1 - y) / slope_;
        most = std::max(most, above(t, height_m(here, r + 1), height_m(there, r + 1), t));
        if (!has_after) return most;
        if (view_.crossed_diagonals) {
            const double at = (2 - y) / (1 + slope_), v = y - 1 + slope_ * at;
            most = std::max(most, above(at, height_m(there, r + 1), height_m(here, r + 2), v));
        }
        return std::max(most, above(1, height_m(there, r + 1), height_m(there, r + 2), end - 1));
    }

    SunView view_;
    int last_;
    double slope_, rise_m_, greatest_m_, doubt_m_ = 0;
};

}  // namespace

ShadowBits near_shadows(const HeightField& field, const HeightSun& sun, int last_line,
                        const ShadowBits& asked) {
    CHECK(asked.width == field.width() && asked.height == field.height() && last_line >= 0);
    const NearRays rays(field, sun, last_line);
    ShadowBits bits(field.width(), field.height());
    for (int line = 0; line < rays.view().lines; ++line) {
        for (int row = 0; row < rays.view().rows; ++row) {
            const GridPlace at = place_of(field, sun, line, row);
            if (asked(at.x, at.y) && rays.hidden(line, row)) bits.set(at.x, at.y);
        }
    }
    return bits;
}

}  // namespace obscura
