// The triangulated surface's height above a ray is linear between the edges that the ray passes over, so it
// is greatest above one of them: to look at the edges is to look at all of the surface. Each edge is judged
// in integers.

#include <algorithm>
#include <cstdlib>

#include "raster/heights/height_march.h"

namespace obscura {
namespace {

using Wide = __int128;
constexpr int rise_per_height_bits = rise_fraction_bits - height_fraction_bits;

/// A corner of the surface as seen along the ray: how far beside it, and how far above it.
struct Corner {
    std::int64_t beside_q20;
    Wide above_q36;
};

struct Ray {
    const SunView& view;
    int line, row;

    bool has(int d, int r) const { return d >= 0 && d <= line && row + r >= 0 && row + r < view.rows; }

    /// The sample d lines nearer the sun and r rows further.
    Corner corner(int d, int r) const {
        const std::int64_t rise_q16 =
            std::int64_t{view.height_q16(line - d, row + r)} - view.height_q16(line, row);
        return {r * cell_q20 - d * view.slope_q20,
                (Wide{rise_q16} << rise_per_height_bits) - Wide{d} * view.rise_q36};
    }

    /// Whether the edge between two corners passes over the ray, and above it.
    bool hidden_by_edge(int d0, int r0, int d1, int r1) const {
        if (!has(d0, r0) || !has(d1, r1)) return false;
        const Corner a = corner(d0, r0), b = corner(d1, r1);
        if (a.beside_q20 == 0 && b.beside_q20 == 0) return a.above_q36 > 0 || b.above_q36 > 0;
        if ((a.beside_q20 > 0 && b.beside_q20 > 0) || (a.beside_q20 < 0 && b.beside_q20 < 0)) return false;
        return std::abs(b.beside_q20) * a.above_q36 + std::abs(a.beside_q20) * b.above_q36 > 0;
    }

    /// Edges between line d - 1 and line d.
    bool hidden_by_strip(int d, int r) const {
        return hidden_by_edge(d - 1, r, d, r) ||
               (view.crossed_diagonals ? hidden_by_edge(d, r, d - 1, r + 1)
                                       : hidden_by_edge(d - 1, r, d, r + 1));
    }
};

}  // namespace

bool sun_hidden(const SunView& view, int line, int row, RayLines lines) noexcept {
    const Ray ray{view, line, row};
    const int first = std::max(lines.first, 0), last = std::min(lines.last, line);
    const Wide highest_q36 = Wide{std::int64_t{view.greatest_q16} - view.height_q16(line, row)}
                             << rise_per_height_bits;
    for (int d = first; d <= last; ++d) {
        const int before = std::max(d - 1, first);
        if (Wide{before} * view.rise_q36 >= highest_q36) return false;
        // Rows that the ray reaches between the line before and this one.
        const int from = static_cast<int>((before * view.slope_q20) >> 20) - 1;
        const int to = static_cast<int>((d * view.slope_q20) >> 20) + 1;
        if (row + from >= view.rows) return false;
        // Of a grid of one row, lines are single samples.
        const int next = view.rows > 1 ? 1 : 0;
        for (int r = from; r <= to; ++r) {
            if (ray.hidden_by_edge(d, r, d, r + next)) return true;
            if (d > first && ray.hidden_by_strip(d, r)) return true;
        }
    }
    return false;
}

ShadowBits march_shadows(const HeightField& field, const HeightSun& sun, RayLines lines) {
    const SunView view = sun_view(field, sun);
    ShadowBits bits(field.width(), field.height());
    for (int line = 0; line < view.lines; ++line) {
        for (int row = 0; row < view.rows; ++row) {
            if (!sun_hidden(view, line, row, lines)) continue;
            const GridPlace at = place_of(field, sun, line, row);
            bits.set(at.x, at.y);
        }
    }
    return bits;
}

}  // namespace obscura
