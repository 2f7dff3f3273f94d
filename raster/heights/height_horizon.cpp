#include "raster/heights/height_horizon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/num.h"
#include "core/parallel.h"
#include "raster/heights/ray_crossings.h"
#include "raster/heights/sun_view.h"

namespace obscura {
namespace {

/// Metres on the ground from line to line along a ray.
double line_length_m(const HeightField& field, const HeightSun& sun) {
    const double slope = static_cast<double>(sun.slope_q20) / static_cast<double>(cell_q20);
    const double across = sun.lines_are_columns ? field.cell_x_m : field.cell_y_m;
    const double along = slope * (sun.lines_are_columns ? field.cell_y_m : field.cell_x_m);
    return std::sqrt(across * across + along * along);
}

}  // namespace

Image<float> horizon_tangents(const HeightField& field, const HeightSun& sun, const Exec& exec) {
    const SunView view = sun_view(field, sun);
    const RayCrossings crossings(view);
    const double length_m = line_length_m(field, sun), greatest_m = metres_of(view.greatest_q16);
    Image<float> tangents(field.width(), field.height());
    parallel_for(static_cast<std::size_t>(view.lines), exec, [&](std::size_t index) {
        const int line = static_cast<int>(index);
        for (int row = 0; row < view.rows; ++row) {
            const double own_m = metres_of(view.height_q16(line, row));
            double steepest = -std::numeric_limits<double>::infinity();
            for (int d = 1; d <= line; ++d) {
                // Nothing further is steeper.
                if (d > 1 && (greatest_m - own_m) / (d - 1) <= steepest) break;
                const bool inside = crossings.strip(line, row, d, [&](double t, double height_m) {
                    const double lines = d - 1 + t;
                    if (lines > 0) steepest = std::max(steepest, (height_m - own_m) / lines);
                });
                if (!inside) break;
            }
            const GridPlace at = place_of(field, sun, line, row);
            tangents(at.x, at.y) = static_cast<float>(steepest / length_m);
        }
    });
    return tangents;
}

double lit_share_of_disc(double elevation_deg, double horizon_deg, double radius_deg) {
    CHECK(radius_deg > 0);
    const double x = (horizon_deg - elevation_deg) / radius_deg;
    if (x >= 1) return 0;
    if (!(x > -1)) return 1;
    return (num::acos(x) - x * std::sqrt(1 - x * x)) / num::pi;
}

}  // namespace obscura
