// Profiles of the air, and its amounts along rays through spherical shells.
//
// Profiles: U.S. Standard Atmosphere, 1976 (NOAA, NASA, USAF), tables of density. E. Bruneton, F. Neyret:
// Precomputed atmospheric scattering, EGSR 2008, section 4 (the table's axes) and table 1; E. Bruneton's
// notes to its 2017 implementation (ozone). The table here holds amounts instead of transmittances: one table
// serves all wavelengths and turbidities.

#include "core/sky/air.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/num.h"
#include "core/sky/exp_lanes.h"

namespace obscura {

namespace {

constexpr double aerosol_scale_height_km = 1.2;
constexpr double ozone_middle_km = 25, ozone_half_width_km = 15;

/// Density of air in kg/m3 by height in km.
struct DensityRow {
    double height_km, density;
};
constexpr std::array<DensityRow, 18> standard_air = {{{0, 1.2250},
                                                      {2, 1.0066},
                                                      {5, 0.73643},
                                                      {8, 0.52579},
                                                      {11, 0.36480},
                                                      {15, 0.19476},
                                                      {20, 0.088910},
                                                      {25, 0.040084},
                                                      {30, 0.018410},
                                                      {40, 3.9957e-3},
                                                      {50, 1.0269e-3},
                                                      {60, 3.0968e-4},
                                                      {70, 8.2829e-5},
                                                      {80, 1.8458e-5},
                                                      {90, 3.416e-6},
                                                      {100, 5.604e-7},
                                                      {110, 9.708e-8},
                                                      {120, 2.222e-8}}};

/// The rows as exponentials: density at the lower end, per column, and its fall per kilometre.
struct Shell {
    double bottom_km = 0, density = 0, fall_per_km = 0;
};

std::array<Shell, standard_air.size() - 1> shells_of_standard_air() {
    std::array<Shell, standard_air.size() - 1> shells;
    double column = 0;
    for (std::size_t i = 0; i < shells.size(); ++i) {
        const DensityRow low = standard_air[i], high = standard_air[i + 1];
        const double fall = num::log(low.density / high.density) / (high.height_km - low.height_km);
        shells[i] = {low.height_km, low.density, fall};
        column += (low.density - high.density) / fall;
    }
    for (Shell& shell : shells)
        shell.density /= column;
    return shells;
}

/// Borders of steps from the ray's lowest point, where its height is `low_km`, up to `high_km`, as distances
/// from there. Heights above the lowest grow with the third power: so steps do along a vertical ray, and with
/// the power 1.5 along the horizon, where the way grows as the root of the height. `perigee_km` is the radius
/// the whole line touches.
std::vector<double> graded(double perigee_km, double low_km, double high_km, int steps) {
    const auto along = [&](double height) {
        const double radius = earth_radius_km + height;
        return std::sqrt(std::max(0.0, (radius - perigee_km) * (radius + perigee_km)));
    };
    std::vector<double> borders;
    for (int i = 0; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        borders.push_back(along(low_km + (high_km - low_km) * (t * t * t)) - along(low_km));
    }
    return borders;
}

/// Axes of the table (Bruneton and Neyret 2008, section 4): the distance to the horizon stands for height,
/// the distance to the top of the air, between its least and its largest value, for the angle.
constexpr double top_radius = earth_radius_km + air_top_km;
constexpr int height_cells = 96, angle_cells = 160;

double horizon_distance(double radius) {
    return std::sqrt(std::max(0.0, radius * radius - earth_radius_km * earth_radius_km));
}

struct AngleRange {
    double least, largest;  ///< distance to the top, upwards and along the horizon
};
AngleRange angle_range(double radius) {
    return {top_radius - radius, horizon_distance(radius) + horizon_distance(top_radius)};
}

std::vector<AirAmount> table_to_space() {
    std::vector<AirAmount> table;
    table.reserve((height_cells + 1) * (angle_cells + 1));
    for (int i = 0; i <= height_cells; ++i) {
        const double to_horizon = horizon_distance(top_radius) * i / height_cells;
        const double radius = std::sqrt(earth_radius_km * earth_radius_km + to_horizon * to_horizon);
        const AngleRange range = angle_range(radius);
        for (int j = 0; j <= angle_cells; ++j) {
            const double d = std::max(1e-6, range.least + (range.largest - range.least) * j / angle_cells);
            const double cosine = (top_radius * top_radius - radius * radius - d * d) / (2 * radius * d);
            // The last ray just misses the ground, whatever rounding says.
            const double cos_zenith = std::clamp(cosine, -to_horizon / radius * (1 - 1e-9), 1.0);
            const std::vector<double> borders = ray_steps(radius - earth_radius_km, cos_zenith, 32);
            AirAmount sum;
            for (std::size_t k = 0; k + 1 < borders.size(); ++k)
                sum = sum + air_along(radius - earth_radius_km, cos_zenith, borders[k], borders[k + 1]);
            table.push_back(sum);
        }
    }
    return table;
}

}  // namespace

AirAmount air_density(double height_km) {
    static const auto shells = shells_of_standard_air();
    const double height = std::clamp(height_km, 0.0, air_top_km);
    std::size_t shell = 0;
    while (shell + 1 < shells.size() && height >= shells[shell + 1].bottom_km)
        ++shell;
    const Shell& s = shells[shell];
    const double off_middle = std::abs(height - ozone_middle_km) / ozone_half_width_km;
    return {s.density * exp_of_depth((s.bottom_km - height) * s.fall_per_km),
            exp_of_depth(-height / aerosol_scale_height_km) / aerosol_scale_height_km,
            std::max(0.0, 1 - off_middle) / ozone_half_width_km};
}

RayEnd ray_end(double height_km, double cos_zenith) {
    const double radius = earth_radius_km + height_km, along = radius * cos_zenith;
    const double to_ground = along * along - height_km * (radius + earth_radius_km);
    if (cos_zenith < 0 && to_ground >= 0) return {true, std::max(0.0, -along - std::sqrt(to_ground))};
    const double to_top = along * along + (air_top_km - height_km) * (radius + top_radius);
    return {false, std::max(0.0, std::sqrt(std::max(0.0, to_top)) - along)};
}

std::vector<double> ray_steps(double height_km, double cos_zenith, int steps) {
    const RayEnd end = ray_end(height_km, cos_zenith);
    const double radius = earth_radius_km + height_km;
    const double perigee = radius * std::sqrt(std::max(0.0, 1 - cos_zenith * cos_zenith));
    const double top = std::max(height_km, air_top_km);
    if (cos_zenith >= 0) return graded(perigee, height_km, top, steps);
    const double lowest = end.on_ground ? 0 : std::max(0.0, perigee - earth_radius_km);
    const auto third = [](double height) { return num::cbrt(height); };
    const double down = third(height_km - lowest), up = end.on_ground ? 0 : third(top - lowest);
    const int before =
        end.on_ground ? steps
                      : std::clamp(static_cast<int>(std::lround(steps * down / (down + up))), 1, steps - 1);
    std::vector<double> borders = graded(perigee, lowest, height_km, before);
    const double to_lowest = borders.back();
    for (double& border : borders)
        border = to_lowest - border;
    std::reverse(borders.begin(), borders.end());
    if (end.on_ground) return borders;
    const std::vector<double> rising = graded(perigee, lowest, top, steps - before);
    for (std::size_t i = 1; i < rising.size(); ++i)
        borders.push_back(to_lowest + rising[i]);
    return borders;
}

double height_along(double height_km, double cos_zenith, double distance_km) {
    const double radius = earth_radius_km + height_km;
    return std::sqrt(radius * radius + distance_km * (distance_km + 2 * radius * cos_zenith)) -
           earth_radius_km;
}

AirAmount air_along(double height_km, double cos_zenith, double from_km, double to_km) {
    const double width = to_km - from_km, middle = from_km + width / 2, spread = 0.28867513459481287 * width;
    const auto density = [&](double at) { return air_density(height_along(height_km, cos_zenith, at)); };
    return (density(middle - spread) + density(middle + spread)) * (width / 2);
}

AirAmount air_to_space(double height_km, double cos_zenith) {
    static const std::vector<AirAmount> table = table_to_space();
    const double radius = earth_radius_km + std::clamp(height_km, 0.0, air_top_km);
    const AngleRange range = angle_range(radius);
    const double along = radius * cos_zenith;
    const double d =
        std::sqrt(std::max(0.0, along * along + (top_radius - radius) * (top_radius + radius))) - along;
    const double x = height_cells * horizon_distance(radius) / horizon_distance(top_radius);
    const double y = angle_cells * std::clamp((d - range.least) / (range.largest - range.least), 0.0, 1.0);
    const int i = std::min(static_cast<int>(x), height_cells - 1),
              j = std::min(static_cast<int>(y), angle_cells - 1);
    const double u = x - i, v = y - j;
    const AirAmount* low =
        &table[static_cast<std::size_t>(i) * (angle_cells + 1) + static_cast<std::size_t>(j)];
    const AirAmount* high = low + (angle_cells + 1);
    return (low[0] * (1 - v) + low[1] * v) * (1 - u) + (high[0] * (1 - v) + high[1] * v) * u;
}

double sun_share(double height_km, double cos_sun_zenith) {
    const double radius = earth_radius_km + height_km;
    const double horizon = -horizon_distance(radius) / radius;
    // Near the horizon a cosine is an angle, up to the sine of the horizon's own.
    const double angle = (cos_sun_zenith - horizon) * radius / earth_radius_km;
    const double t = std::clamp(angle / (2 * sun_radius_deg * num::pi / 180) + 0.5, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace obscura
