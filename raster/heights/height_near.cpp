// The march of height_march_ref.cpp in doubles, line after line. A height above the ray that is nearer to 0
// than rounding can bring it is no answer, and if no other edge gives one, integers do.

#include "raster/heights/height_near.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "raster/heights/height_march.h"
#include "raster/heights/ray_crossings.h"
#include "raster/heights/sun_view.h"

namespace obscura {
namespace {

class NearRays {
  public:
    NearRays(const HeightField& field, const HeightSun& sun, int last_line)
        : view_(sun_view(field, sun)),
          crossings_(view_),
          last_(last_line),
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
    /// Nothing where doubles cannot tell.
    std::optional<bool> march(int line, int row) const {
        const double own_m = metres_of(view_.height_q16(line, row));
        double highest_m = -1e300;
        for (int d = 1; d <= std::min(last_, line); ++d) {
            const double ray_m = own_m + rise_m_ * (d - 1);
            if (ray_m - doubt_m_ > greatest_m_) break;
            const bool inside = crossings_.strip(line, row, d, [&](double t, double height_m) {
                highest_m = std::max(highest_m, height_m - (ray_m + rise_m_ * t));
            });
            if (!inside) break;
            if (highest_m > doubt_m_) return true;
        }
        if (highest_m >= -doubt_m_) return {};
        return false;
    }

    SunView view_;
    RayCrossings crossings_;
    int last_;
    double rise_m_, greatest_m_, doubt_m_ = 0;
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
