#pragma once
// What the air consists of at which height, and how much of it lies along a ray to space.

#include <vector>

namespace obscura {

constexpr double earth_radius_km = 6371;
constexpr double air_top_km = 120;           ///< above it nothing scatters
constexpr double sun_radius_deg = 0.53 / 2;  ///< as seen from the earth

/// Molecules, aerosol and ozone, each in units of what lies above a square of sea level. An amount per
/// kilometre is a density; the sum along a ray is its air mass.
struct AirAmount {
    double molecules = 0, aerosol = 0, ozone = 0;
};

constexpr AirAmount operator+(AirAmount a, AirAmount b) {
    return {a.molecules + b.molecules, a.aerosol + b.aerosol, a.ozone + b.ozone};
}
constexpr AirAmount operator*(AirAmount a, double s) {
    return {a.molecules * s, a.aerosol * s, a.ozone * s};
}

/// Density per kilometre at a height in [0, air_top_km]; each part integrates to 1.
///  - molecules: U.S. Standard Atmosphere 1976, exponential between the heights of its table;
///  - aerosol: exponential, scale height 1.2 km (Bruneton and Neyret 2008, table 1);
///  - ozone: a tent from 10 to 40 km (Bruneton 2017, after the standard atmosphere's profile).
AirAmount air_density(double height_km);

/// Whether a ray from `height_km` at this cosine of the zenith angle ends on the ground, and how far it goes
/// to there or to the top of the air.
struct RayEnd {
    bool on_ground = false;
    double distance_km = 0;
};
RayEnd ray_end(double height_km, double cos_zenith);

/// Borders of `steps` >= 2 steps along the whole ray, as distances from its start, short where the air is
/// dense: see graded() in air.cpp.
std::vector<double> ray_steps(double height_km, double cos_zenith, int steps);

/// Height after a distance along a ray.
double height_along(double height_km, double cos_zenith, double distance_km);

/// Air in one step of a ray, by Gauss's rule of two points.
AirAmount air_along(double height_km, double cos_zenith, double from_km, double to_km);

/// Air from a height to space along a ray that misses the ground (one that does not is taken as if it just
/// touched it). From a table, constant data made once in 40 ms; of what a quadrature gives, molecules are
/// within 0.4 % (0.05 % below 7 km), ozone 0.9 %, aerosol 0.3 % below 2.5 km and 5 % where there is hardly
/// any (tests/sky).
AirAmount air_to_space(double height_km, double cos_zenith);

/// Share of the sun's disc above the local horizon: 1, 0, or smoothly between within the disc's radius.
double sun_share(double height_km, double cos_sun_zenith);

}  // namespace obscura
