#pragma once
// A sun's direction on a grid of heights, in the numbers that shadows are exact in.

#include <cstdint>

#include "raster/heights/height_field.h"

namespace obscura {

constexpr std::int64_t cell_q20 = std::int64_t{1} << 20;  ///< one cell, in units of slope_q20
constexpr int rise_fraction_bits = 36;                    ///< of rise_q36

/// Towards the sun one goes from line to line of the grid: columns of samples when the sun stands more east
/// or west than north or south (counted in cells), else rows. From one line to the next one moves along the
/// line by at most a cell, and a ray rises. Both are rounded, the azimuth by less than 3e-5 degrees (times
/// the ratio of a cell's sides), and from then on nothing is: what is computed for a HeightSun is what real
/// arithmetic gives for it.
struct HeightSun {
    bool lines_are_columns = true;
    std::int8_t step_line = 1;   ///< 1 when column (row) numbers grow towards the sun, else -1
    std::int8_t step_along = 1;  ///< the same along a line
    std::int64_t slope_q20 = 0;  ///< along a line, per line, in 2^-20 cells: [0, 2^20]
    std::int64_t rise_q36 = 1;  ///< of a ray, per line, in 2^-36 m: [1, 2^53]; beyond, nothing casts a shadow
    friend bool operator==(const HeightSun&, const HeightSun&) = default;
};

/// The horizontal direction (east, north), not both 0 and of any length, and the tangent of the elevation,
/// above 0.
HeightSun height_sun_towards(const HeightField& field, double east, double north, double tan_elevation);

/// azimuth_deg clockwise from the grid's north (up), elevation_deg in (0, 90].
HeightSun height_sun(const HeightField& field, double azimuth_deg, double elevation_deg);

}  // namespace obscura
