#pragma once
// Small grids of many kinds, drawn by number.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "raster/heights/height_field.h"
#include "raster/heights/height_sun.h"

namespace obscura::drawn {

using Random = std::mt19937_64;

inline int below(Random& random, int n) {
    return static_cast<int>(random() % static_cast<std::uint64_t>(n));
}

inline double unit(Random& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Planes, pyramids, spikes, walls, steps of whole metres (many ties), noise, and noise on hills.
inline HeightField heights(Random& random, int largest_side = 22) {
    HeightField f;
    const int w = below(random, 8) == 0 ? 1 : 1 + below(random, largest_side);
    const int h = below(random, 8) == 0 ? 1 : 1 + below(random, largest_side);
    f.height_q16 = Image<std::int32_t>(w, h);
    constexpr double cells[] = {1, 0.5, 30, 74.4012};
    f.cell_x_m = cells[below(random, 4)];
    f.cell_y_m = below(random, 2) == 0 ? f.cell_x_m : cells[below(random, 4)];
    f.diagonal = below(random, 2) == 0 ? Diagonal::falling : Diagonal::rising;
    const int kind = below(random, 7);
    const double steep = f.cell_x_m * (0.1 + unit(random));
    const int ax = below(random, 5) - 2, ay = below(random, 5) - 2;
    const int px = below(random, w), py = below(random, h);
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            double m = 0;
            if (kind == 0) m = ax * x + ay * y;
            if (kind == 1) m = steep * std::max(0, 5 - std::max(std::abs(x - px), std::abs(y - py)));
            if (kind == 2) m = x == px && y == py ? 7 * steep : 0;
            if (kind == 3) m = x == px || y == py ? 3 * steep : 0;
            if (kind == 4) m = below(random, 4);
            if (kind == 5) m = steep * unit(random);
            if (kind == 6)
                m = steep * (2 * std::sin(0.4 * x + ax) + 2 * std::sin(0.3 * y + ay) + unit(random));
            f.height_q16(x, y) = height_q16_of(m);
        }
    }
    return f;
}

/// Anywhere, along an axis, along a diagonal of the cells, and of rises that give ties with whole metres.
inline HeightSun sun(Random& random, const HeightField& f) {
    const int kind = below(random, 5);
    double east = 2 * unit(random) - 1, north = 2 * unit(random) - 1;
    if (kind == 1) (below(random, 2) == 0 ? east : north) = 0;
    if (kind == 2) {
        east = below(random, 2) == 0 ? f.cell_x_m : -f.cell_x_m;
        north = below(random, 2) == 0 ? f.cell_y_m : -f.cell_y_m;
    }
    HeightSun s = height_sun_towards(f, east, north, 0.01 + 1.2 * unit(random) * unit(random));
    if (kind >= 3) s.rise_q36 = std::int64_t{1 + below(random, 4)} << (rise_fraction_bits - below(random, 3));
    if (kind == 4) s.slope_q20 = cell_q20 / 4 * below(random, 5);
    return s;
}

/// The sun that stands over the turned, and over the mirrored ground as this one does over this.
inline HeightSun turned(const HeightSun& s) {
    HeightSun t = s;
    t.lines_are_columns = !s.lines_are_columns;
    // What was down is left, what was right is down.
    (s.lines_are_columns ? t.step_along : t.step_line) =
        static_cast<std::int8_t>(-(s.lines_are_columns ? s.step_along : s.step_line));
    return t;
}

inline HeightSun mirrored(const HeightSun& s) {
    HeightSun t = s;
    std::int8_t& x = s.lines_are_columns ? t.step_line : t.step_along;
    x = static_cast<std::int8_t>(-x);
    return t;
}

}  // namespace obscura::drawn
