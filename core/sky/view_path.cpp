// S. Hillaire: A scalable and production ready sky and atmosphere rendering technique, EGSR 2020, section 5:
// the march along a ray. Steps here are graded, and the sun's light stays apart, so that rays of one height
// share all of this.

#include "core/sky/view_path.h"

#include <algorithm>
#include <cmath>

#include "core/sky/exp_lanes.h"

namespace obscura {

namespace {

double cos_sun_after(const ViewPath& path, double distance, double height, double cos_sun,
                     double cos_between) {
    const double start = earth_radius_km + path.start_height_km;
    return (start * cos_sun + distance * cos_between) / (earth_radius_km + height);
}

}  // namespace

ViewPath view_path(const AirSpectrum& air, double height_km, double cos_zenith, int steps) {
    ViewPath path{height_km, cos_zenith, ray_end(height_km, cos_zenith), {}, {}};
    const std::vector<double> borders = ray_steps(height_km, cos_zenith, steps);
    const auto count = static_cast<std::size_t>(air.count);
    path.passed.fill(1);
    for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
        const double middle = (borders[k] + borders[k + 1]) / 2;
        const AirAmount amount = air_along(height_km, cos_zenith, borders[k], borders[k + 1]);
        PathStep step{middle, height_along(height_km, cos_zenith, middle), {}, {}};
        for (std::size_t i = 0; i < count; ++i) {
            const double molecules = air.molecules[i] * amount.molecules;
            const double aerosol = air.aerosol[i] * amount.aerosol;
            const double depth = molecules + aerosol + air.ozone[i] * amount.ozone;
            const double kept = exp_of_depth(-depth);
            // Mean of the step's own transmittance; its series where the difference has no digits left.
            const double mean = depth > 1e-4 ? (1 - kept) / depth : 1 - depth / 2;
            step.molecules[i] = path.passed[i] * mean * molecules;
            step.aerosol[i] = path.passed[i] * mean * aerosol * air.aerosol_scattered;
            path.passed[i] *= kept;
        }
        path.steps.push_back(step);
    }
    return path;
}

double cos_sun_at(const ViewPath& path, const PathStep& step, double cos_sun, double cos_between) {
    return cos_sun_after(path, step.distance_km, step.height_km, cos_sun, cos_between);
}

double cos_sun_at_end(const ViewPath& path, double cos_sun, double cos_between) {
    return cos_sun_after(path, path.end.distance_km, path.end.on_ground ? 0 : air_top_km, cos_sun,
                         cos_between);
}

}  // namespace obscura
