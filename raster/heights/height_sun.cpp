#include "raster/heights/height_sun.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/num.h"

namespace obscura {

HeightSun height_sun_towards(const HeightField& field, double east, double north, double tan_elevation) {
    CHECK(std::isfinite(east) && std::isfinite(north) && (east != 0 || north != 0) && tan_elevation > 0);
    // Cells per unit of the direction; rows count southwards.
    const double x = east / field.cell_x_m, y = -north / field.cell_y_m;
    HeightSun sun;
    sun.lines_are_columns = std::fabs(x) >= std::fabs(y);
    const double across = sun.lines_are_columns ? x : y, along = sun.lines_are_columns ? y : x;
    sun.step_line = across < 0 ? -1 : 1;
    sun.step_along = along < 0 ? -1 : 1;
    sun.slope_q20 = static_cast<std::int64_t>(
        std::floor(std::fabs(along) / std::fabs(across) * static_cast<double>(cell_q20) + 0.5));
    const double metres_per_line = std::sqrt(east * east + north * north) / std::fabs(across);
    const double rise =
        metres_per_line * tan_elevation * static_cast<double>(std::int64_t{1} << rise_fraction_bits);
    constexpr double steepest = static_cast<double>(std::int64_t{1} << 53);
    sun.rise_q36 = static_cast<std::int64_t>(std::floor(std::clamp(rise, 1.0, steepest) + 0.5));
    return sun;
}

HeightSun height_sun(const HeightField& field, double azimuth_deg, double elevation_deg) {
    CHECK(elevation_deg > 0 && elevation_deg <= 90);
    // At the zenith the tangent is infinite, and as good as very large.
    const double level = std::max(num::cos_deg(elevation_deg), 1e-12);
    return height_sun_towards(field, num::sin_deg(azimuth_deg), num::cos_deg(azimuth_deg),
                              num::sin_deg(elevation_deg) / level);
}

}  // namespace obscura
