#pragma once
// The clear sky by day and in twilight, computed from the air, and the sun seen through the same air.

#include "core/image.h"
#include "core/isa.h"
#include "core/sky/air_spectrum.h"
#include "core/sky/scattered_light.h"
#include "core/vec.h"

namespace obscura {

/// Turbidity and ground of a place; what is computed for them serves all heights of the sun.
struct ClearAirParams {
    double turbidity = 3;                ///< [1.7, 10]: 2 very clear, 3 clear, 6 hazy (Preetham et al. 1999)
    Vec3d ground_albedo{0.2, 0.2, 0.2};  ///< each in [0, 1]
    /// Irradiance of the sun above the air, linear sRGB, on the scene's own scale (`extraterrestrial_w_m2`).
    /// Equal channels balance white to that sun; sun_above_air_true() leaves its colour as it is.
    Vec3d sun_above_air_w_m2{5, 5, 5};
    int wavelengths = 10;  ///< [4, 40]
    friend bool operator==(const ClearAirParams&, const ClearAirParams&) = default;
};

struct ClearAir {
    ClearAirParams params;
    AirSpectrum spectrum;
    ScatteredLight scattered;
};

/// CHECKs the ranges above. About 0.13 s on one thread.
ClearAir clear_air(const ClearAirParams& params, const Exec& exec);

/// Unit vector towards azimuth (clockwise from north, which is -Z) and elevation.
Vec3d compass_direction(double azimuth_deg, double elevation_deg);

/// The sky under one sun. Tables over direction, which sky_radiance() reads: what molecules and aerosol
/// scatter of the sun's own light, before their phase functions, and what is scattered more than once.
struct ClearSky {
    ClearAir air;
    double sun_azimuth_deg = 0, sun_elevation_deg = 0;
    Vec3d towards_sun{0, 1, 0}, level_sun{0, 0, -1};  ///< unit; level_sun has the same azimuth
    Image<Vec3f> molecules, aerosol, multiple;
    Vec3f sun_irradiance_w_m2;  ///< on a surface that faces the sun; 0 when its disc has set
    Vec3f sky_irradiance_w_m2;  ///< on level ground, without the sun's disc
    Vec3f ground_radiance;  ///< of the ground below the horizon: albedo times all that reaches it, over pi
};

/// Elevation in [-90, 90] of the disc's middle as it is seen, so with refraction where there is any
/// (SunPosition::apparent_elevation_deg). The same bits for every exec. About 0.02 s on one
/// thread.
ClearSky clear_sky(const ClearAir& air, double sun_azimuth_deg, double sun_elevation_deg, const Exec& exec);

/// Radiance from a unit direction, W/(m2 sr) per channel, never negative, without the sun's disc; the
/// ground's below the horizon. Interpolated: within 0.3 % of clear_sky_radiance_direct() by day, 2 % at dusk
/// (tests/sky). No transcendental function.
Vec3f sky_radiance(const ClearSky& sky, Vec3d direction);

/// The same without tables of directions, along a ray of `steps` steps: the oracle. Above the horizon only.
Vec3d clear_sky_radiance_direct(const ClearSky& sky, Vec3d direction, int steps);

/// Irradiance of the sun's disc on a surface that faces it, linear sRGB, when its middle is seen at this
/// elevation; less as it sets, 0 once it has. Colours outside sRGB's gamut keep their luminance
/// (into_gamut()).
Vec3f sun_irradiance(const AirSpectrum& air, double elevation_deg);

/// Radiance of the sun's disc alone in this direction; 0 beside it. Darker towards its limb (Hestroffer and
/// Magnan 1998) and lower down, together sun_irradiance_w_m2.
Vec3f sun_disc_radiance(const ClearSky& sky, Vec3d direction);

}  // namespace obscura
