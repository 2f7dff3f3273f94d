// S. Hillaire: A scalable and production ready sky and atmosphere rendering technique, EGSR 2020, section 5: the march
// along a ray. Steps here are graded, and the sun's light stays apart, so that rays of one height share all of this.

#include "core/sky/view_path.h"

#include <algorithm>
#include <cmath>

#include "core/num.h"
#include "core/sky/exp_lanes.h"

namespace obscura {

namespace {

/// Borders of steps from 0 to `length` that grow from about `first` on.
std::vector<double> graded(double length, double first, int steps) {
    std::vector<double> borders;
    const double growth = num::exp(num::log(1 + length / first) / steps);
    double grown = 1;
    for (int i = 0; i <= steps; ++i) {
        borders.push_back(i == steps ? length : first * (grown - 1));
        grown *= growth;
    }
    return borders;
}

std::vector<double> borders_of(double height_km, double cos_zenith, double length, int steps) {
    const double first_km = 1;
    const double lowest = std::clamp(-(earth_radius_km + height_km) * cos_zenith, 0.0, length);
    if (lowest == 0) return graded(length, first_km, steps);
    // As many steps on either side as there is way, in logarithms.
    const double down = num::log(1 + lowest / first_km), up = num::log(1 + (length - lowest) / first_km);
    const int before = std::clamp(static_cast<int>(steps * down / (down + up) + 0.5), 1, steps);
    std::vector<double> borders = graded(lowest, first_km, before);
    for (double& border : borders)
        border = lowest - border;
    std::reverse(borders.begin(), borders.end());
    if (before == steps) return borders;
    const std::vector<double> rising = graded(length - lowest, first_km, steps - before);
    for (std::size_t i = 1; i < rising.size(); ++i)
        borders.push_back(lowest + rising[i]);
    return borders;
}

double height_at(double height_km, double cos_zenith, double distance) {
    const double radius = earth_radius_km + height_km;
    return std::sqrt(radius * radius + distance * (distance + 2 * radius * cos_zenith)) - earth_radius_km;
}

double cos_sun_after(const ViewPath& path, double distance, double height, double cos_sun, double cos_between) {
    const double start = earth_radius_km + path.start_height_km;
    return (start * cos_sun + distance * cos_between) / (earth_radius_km + height);
}

}  // namespace

ViewPath view_path(const AirSpectrum& air, double height_km, double cos_zenith, int steps) {
    ViewPath path{height_km, cos_zenith, ray_end(height_km, cos_zenith), {}, {}};
    const std::vector<double> borders = borders_of(height_km, cos_zenith, path.end.distance_km, steps);
    const auto count = static_cast<std::size_t>(air.count);
    path.passed.fill(1);
    for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
        const double begin = borders[k], width = borders[k + 1] - begin, middle = begin + width / 2;
        const double spread = 0.28867513459481287 * width;
        const AirAmount amount = (air_density(height_at(height_km, cos_zenith, middle - spread)) +
                                  air_density(height_at(height_km, cos_zenith, middle + spread))) *
                                 (width / 2);
        PathStep step{middle, height_at(height_km, cos_zenith, middle), {}, {}};
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
    return cos_sun_after(path, path.end.distance_km, path.end.on_ground ? 0 : air_top_km, cos_sun, cos_between);
}

}  // namespace obscura
