#pragma once
// The overcast sky: no sun, three times as bright above as at the horizon.

#include "core/vec.h"

namespace obscura {

/// Radiance is the same at all azimuths.
struct OvercastSky {
    Vec3f zenith{0, 0, 0};           ///< radiance straight up, W/(m2 sr) per channel
    Vec3f ground_radiance{0, 0, 0};  ///< below the horizon
};

/// Grey (the white of D65 under a sun of equal channels' scale) with the brightness of a day whose sun stands
/// at this elevation in [-90, 90] above the clouds: 300 + 21000 sin(elevation) lx on level ground (J.
/// Krochmann, M. Seidl 1974: Quantitative data on daylight for illuminating engineering, Lighting Research
/// and Technology 6); below the horizon it fades as the clear twilight does (P. Janiczek, J. DeYoung 1987,
/// see clear_twilight_lux()). `sun_above_air_w_m2` is that of ClearAirParams.
OvercastSky overcast_sky(double sun_elevation_deg, Vec3d sun_above_air_w_m2, Vec3d ground_albedo);

/// CIE standard overcast sky: zenith times (1 + 2 sin(elevation)) / 3 (P. Moon, D. Spencer 1942: Illumination
/// from a non-uniform sky, Illum. Eng. 37; CIE 1955).
Vec3f sky_radiance(const OvercastSky& sky, Vec3d direction);

/// Illuminance of level ground by a clear sky and its sun, in lux, for sun elevations in [-18, 90] degrees:
/// the curve of P. Janiczek and J. DeYoung, Computer programs for sun and moon illuminance, U.S. Naval
/// Observatory Circular 171, 1987 (P. Seidelmann, Explanatory Supplement to the Astronomical Almanac, 1992,
/// section 9.35).
double clear_twilight_lux(double sun_elevation_deg);

}  // namespace obscura
