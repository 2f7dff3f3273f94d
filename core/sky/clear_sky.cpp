// Radiance of a clear sky: single scattering along rays from the ground, what was scattered before as even
// light.
//
// S. Hillaire: A scalable and production ready sky and atmosphere rendering technique, EGSR 2020,
// sections 5.2 to 5.5. E. Bruneton, F. Neyret: Precomputed atmospheric scattering, EGSR 2008, section 4:
// phase functions stay out of tables. Limb: D. Hestroffer, C. Magnan: Wavelength dependency of the solar limb
// darkening, A&A 333 (1998).

#include "core/sky/clear_sky.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/num.h"
#include "core/observer.h"
#include "core/parallel.h"
#include "core/sky/exp_lanes.h"
#include "core/sky/view_path.h"

namespace obscura {

namespace {

constexpr int elevation_cells = 80, azimuth_cells = 40, table_steps = 48;
constexpr int orders = 4;

/// What a ray from the ground sees, by how it was scattered: before the phase functions, which are 4 pi times
/// 1 on average, the first two.
struct Scattered {
    Vec3d molecules, aerosol, multiple;
};

Scattered scattered_along(const ClearAir& air, const ViewPath& path, double cos_sun, double cos_between) {
    const auto count = static_cast<std::size_t>(air.spectrum.count);
    Spectrum molecules{}, aerosol{}, multiple{}, light;
    for (const PathStep& step : path.steps) {
        const double local = cos_sun_at(path, step, cos_sun, cos_between);
        const double share = sun_share(step.height_km, local);
        if (share > 0) {
            transmittance(air.spectrum, air_to_space(step.height_km, local), share / (4 * num::pi), light);
            for (std::size_t i = 0; i < count; ++i) {
                molecules[i] += light[i] * step.molecules[i];
                aerosol[i] += light[i] * step.aerosol[i];
            }
        }
        mean_radiance(air.scattered, step.height_km, local, light);
        for (std::size_t i = 0; i < count; ++i)
            multiple[i] += light[i] * (step.molecules[i] + step.aerosol[i]);
    }
    return {rgb_of(air.spectrum, molecules), rgb_of(air.spectrum, aerosol), rgb_of(air.spectrum, multiple)};
}

/// Rows stand densest at the horizon, with q = sqrt(1 - tan(zenith angle / 2)); columns are even in the
/// cosine of the azimuth from the sun, of which everything here is a smooth function. Neither needs an angle.
double elevation_axis(double sine) {
    const double level = std::sqrt(std::max(0.0, 1 - sine * sine));
    return std::sqrt(std::max(0.0, 1 - level / (1 + sine)));
}
double sine_of_axis(double q) {
    const double t = 1 - q * q;
    return (1 - t * t) / (1 + t * t);
}

Vec3d mix(Vec3d a, Vec3d b, double t) {
    return a + (b - a) * t;
}

struct Corner {
    int x, y;
    double u, v;
};
Vec3d interpolate(const Image<Vec3f>& table, const Corner& c) {
    const Vec3f* low = table.row(c.y) + c.x;
    const Vec3f* high = table.row(c.y + 1) + c.x;
    return mix(mix(to_double(low[0]), to_double(low[1]), c.u),
               mix(to_double(high[0]), to_double(high[1]), c.u), c.v);
}

Corner corner_of(const ClearSky& sky, Vec3d direction) {
    const double level = std::sqrt(direction.x * direction.x + direction.z * direction.z);
    const double cosine = level > 0 ? dot(direction, sky.level_sun) / level : 0;
    const double x = std::clamp((1 + cosine) / 2, 0.0, 1.0) * azimuth_cells;
    const double y = elevation_axis(std::min(direction.y, 1.0)) * elevation_cells;
    const int i = std::min(static_cast<int>(x), azimuth_cells - 1);
    const int j = std::min(static_cast<int>(y), elevation_cells - 1);
    return {i, j, x - i, y - j};
}

Vec3d with_phases(const Scattered& light, double cos_between) {
    return light.molecules * molecules_phase(cos_between) + light.aerosol * aerosol_phase(cos_between) +
           light.multiple;
}

/// Row `y` of the tables.
void fill_row(ClearSky& sky, int y) {
    const double sine = sine_of_axis(static_cast<double>(y) / elevation_cells);
    const double level = std::sqrt(std::max(0.0, 1 - sine * sine));
    const ViewPath path = view_path(sky.air.spectrum, 0, sine, table_steps);
    const double level_of_sun = dot(sky.towards_sun, sky.level_sun);
    for (int x = 0; x <= azimuth_cells; ++x) {
        const double cos_azimuth = 2.0 * x / azimuth_cells - 1;
        const double cos_between = sine * sky.towards_sun.y + level * level_of_sun * cos_azimuth;
        const Scattered light = scattered_along(sky.air, path, sky.towards_sun.y, cos_between);
        sky.molecules(x, y) = to_float(light.molecules);
        sky.aerosol(x, y) = to_float(light.aerosol);
        sky.multiple(x, y) = to_float(light.multiple);
    }
}

/// Of level ground, by the middles of bands of equal sine and of azimuths on one side of the sun.
Vec3f sky_irradiance(const ClearSky& sky) {
    const int bands = 64, azimuths = 48;
    Vec3d sum;
    for (int band = 0; band < bands; ++band) {
        const double sine = (band + 0.5) / bands, level = std::sqrt(1 - sine * sine);
        for (int i = 0; i < azimuths; ++i) {
            const double turn = 180.0 * (i + 0.5) / azimuths;
            const Vec3d across{-sky.level_sun.z, 0, sky.level_sun.x};
            const Vec3d flat =
                sky.level_sun * (level * num::cos_deg(turn)) + across * (level * num::sin_deg(turn));
            sum = sum + to_double(sky_radiance(sky, {flat.x, sine, flat.z})) * sine;
        }
    }
    return to_float(sum * (2 * num::pi / (bands * azimuths)));
}

constexpr double sun_radius = sun_radius_deg * num::pi / 180;

/// Share of the sun's light that arrives, by wavelength: the mean over bands of its disc above the horizon.
Spectrum sun_passed(const AirSpectrum& air, double elevation_deg) {
    const int bands = 12;
    Spectrum sum{}, light;
    double whole = 0;
    for (int band = 0; band < bands; ++band) {
        const double offset = 2 * (band + 0.5) / bands - 1, chord = std::sqrt(1 - offset * offset);
        whole += chord;
        const double elevation = elevation_deg + offset * sun_radius_deg;
        if (elevation <= 0) continue;
        transmittance(air, air_to_space(0, num::sin_deg(elevation)), chord, light);
        for (std::size_t i = 0; i < static_cast<std::size_t>(air.count); ++i)
            sum[i] += light[i];
    }
    for (double& share : sum)
        share /= whole;
    return sum;
}

}  // namespace

ClearAir clear_air(const ClearAirParams& params, const Exec& exec) {
    CHECK(params.turbidity >= 1.7 && params.turbidity <= 10);
    const Vec3d albedo = params.ground_albedo;
    CHECK(std::min({albedo.x, albedo.y, albedo.z}) >= 0 && std::max({albedo.x, albedo.y, albedo.z}) <= 1);
    ClearAir air{params, air_spectrum(params.turbidity, params.sun_above_air_w_m2, params.wavelengths), {}};
    air.scattered = scattered_light(air.spectrum, reflectance(air.spectrum, albedo), orders, exec);
    return air;
}

Vec3d compass_direction(double azimuth_deg, double elevation_deg) {
    const double level = num::cos_deg(elevation_deg);
    return {level * num::sin_deg(azimuth_deg), num::sin_deg(elevation_deg),
            -level * num::cos_deg(azimuth_deg)};
}

ClearSky clear_sky(const ClearAir& air, double sun_azimuth_deg, double sun_elevation_deg, const Exec& exec) {
    CHECK(sun_elevation_deg >= -90 && sun_elevation_deg <= 90);
    ClearSky sky;
    sky.air = air;
    sky.sun_azimuth_deg = sun_azimuth_deg;
    sky.sun_elevation_deg = sun_elevation_deg;
    sky.towards_sun = compass_direction(sun_azimuth_deg, sun_elevation_deg);
    sky.level_sun = compass_direction(sun_azimuth_deg, 0);
    for (Image<Vec3f>* table : {&sky.molecules, &sky.aerosol, &sky.multiple})
        *table = Image<Vec3f>(azimuth_cells + 1, elevation_cells + 1);
    parallel_for(elevation_cells + 1, exec, [&](std::size_t y) { fill_row(sky, static_cast<int>(y)); });
    sky.sun_irradiance_w_m2 = sun_irradiance(air.spectrum, sun_elevation_deg);
    sky.sky_irradiance_w_m2 = sky_irradiance(sky);
    const Vec3d down = to_double(sky.sky_irradiance_w_m2) +
                       to_double(sky.sun_irradiance_w_m2) * std::max(0.0, sky.towards_sun.y);
    sky.ground_radiance = to_float(down * air.params.ground_albedo * (1 / num::pi));
    return sky;
}

Vec3f sky_radiance(const ClearSky& sky, Vec3d direction) {
    if (direction.y < 0) return sky.ground_radiance;
    const Corner corner = corner_of(sky, direction);
    const Scattered light{interpolate(sky.molecules, corner), interpolate(sky.aerosol, corner),
                          interpolate(sky.multiple, corner)};
    const double cos_between = std::clamp(dot(direction, sky.towards_sun), -1.0, 1.0);
    return to_float(into_gamut(with_phases(light, cos_between)));
}

Vec3d clear_sky_radiance_direct(const ClearSky& sky, Vec3d direction, int steps) {
    CHECK(direction.y >= 0 && steps >= 1);
    const ViewPath path = view_path(sky.air.spectrum, 0, std::min(direction.y, 1.0), steps);
    const double cos_between = std::clamp(dot(direction, sky.towards_sun), -1.0, 1.0);
    const Scattered light = scattered_along(sky.air, path, sky.towards_sun.y, cos_between);
    return into_gamut(with_phases(light, cos_between));
}

Vec3f sun_irradiance(const AirSpectrum& air, double elevation_deg) {
    return to_float(into_gamut(rgb_of(air, sun_passed(air, elevation_deg))));
}

Vec3f sun_disc_radiance(const ClearSky& sky, Vec3d direction) {
    // The sine of the angle from the disc's middle, in radii; a cosine has no digits for it.
    const double off = length(cross(direction, sky.towards_sun)) / num::sin_deg(sun_radius_deg);
    if (!(off < 1) || dot(direction, sky.towards_sun) < 0 || direction.y < 0) return {};
    const AirSpectrum& air = sky.air.spectrum;
    Spectrum light;
    transmittance(air, air_to_space(0, direction.y), 1 / (num::pi * sun_radius * sun_radius), light);
    const double log_cosine = 0.5 * num::log(1 - off * off);
    for (std::size_t i = 0; i < static_cast<std::size_t>(air.count); ++i) {
        const double nm = air.wavelength_nm[i];
        const double power = nm > 417 ? 292 / nm - 0.023 : 441 / nm - 0.507;
        light[i] *= (power + 2) / 2 * exp_of_depth(power * log_cosine);
    }
    return to_float(into_gamut(rgb_of(air, light)));
}

}  // namespace obscura
