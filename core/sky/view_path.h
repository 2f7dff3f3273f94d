#pragma once
// A ray through the air in steps, and what each of them scatters towards its start.

#include <vector>

#include "core/sky/air_spectrum.h"

namespace obscura {

/// Light that arrives evenly from all sides with radiance 1 in the middle of a step reaches the ray's start
/// as radiance `molecules` + `aerosol`.
struct PathStep {
    double distance_km = 0, height_km = 0;  ///< of its middle
    Spectrum molecules{}, aerosol{};
};

struct ViewPath {
    double start_height_km = 0, cos_zenith = 1;
    RayEnd end;
    std::vector<PathStep> steps;
    Spectrum passed{};  ///< share of light from the end that reaches the start
};

/// Steps grow away from the ray's lowest point; within a step light fades exponentially and is scattered as
/// in its middle (Hillaire 2020, section 5.2, after Hillaire 2016). Second order in the length of steps.
ViewPath view_path(const AirSpectrum& air, double height_km, double cos_zenith, int steps);

/// Cosine of the sun's zenith angle, as seen from a point of a ray: `cos_sun` at the ray's start,
/// `cos_between` from the ray to the sun.
double cos_sun_at(const ViewPath& path, const PathStep& step, double cos_sun, double cos_between);
double cos_sun_at_end(const ViewPath& path, double cos_sun, double cos_between);

}  // namespace obscura
