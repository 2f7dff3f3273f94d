// Overcast skies: a formula for their shape, one for how bright they are.

#include "core/sky/overcast_sky.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/num.h"
#include "core/sky/air_spectrum.h"

namespace obscura {

namespace {

/// log10 of lux = a + b x + c x^2 + d x^3 with x = elevation / 90, from this elevation up.
struct LuxRow {
    double from_deg, a, b, c, d;
};
constexpr std::array<LuxRow, 6> lux_rows = {{{20, 3.74, 3.97, -4.07, 1.47},
                                             {5, 3.05, 13.28, -45.98, 64.33},
                                             {-0.8, 2.88, 22.26, -207.64, 1034.30},
                                             {-5, 2.88, 21.81, -258.11, -858.36},
                                             {-12, 2.70, 12.17, -431.69, -1899.83},
                                             {-18, 13.84, 262.72, 1447.42, 2797.93}}};

}  // namespace

double clear_twilight_lux(double sun_elevation_deg) {
    const double elevation = std::clamp(sun_elevation_deg, -18.0, 90.0), x = elevation / 90;
    const auto row = std::find_if(lux_rows.begin(), lux_rows.end(),
                                  [&](const LuxRow& r) { return elevation >= r.from_deg; });
    return num::pow(10, row->a + x * (row->b + x * (row->c + x * row->d)));
}

OvercastSky overcast_sky(double sun_elevation_deg, Vec3d sun_above_air_w_m2, Vec3d ground_albedo) {
    CHECK(sun_elevation_deg >= -90 && sun_elevation_deg <= 90);
    const double dusk = 300;
    const double lux = sun_elevation_deg >= 0
                           ? dusk + 21000 * num::sin_deg(sun_elevation_deg)
                           : dusk * clear_twilight_lux(sun_elevation_deg) / clear_twilight_lux(0);
    // Of level ground: pi times 7/9 of the zenith.
    const double zenith = lux / lux_per_watt() * 9 / (7 * num::pi);
    const Vec3d sun = sun_above_air_true();
    const Vec3d scale{sun_above_air_w_m2.x / sun.x, sun_above_air_w_m2.y / sun.y,
                      sun_above_air_w_m2.z / sun.z};
    return {to_float(scale * zenith), to_float(scale * ground_albedo * (zenith * 7 / 9))};
}

Vec3f sky_radiance(const OvercastSky& sky, Vec3d direction) {
    if (direction.y < 0) return sky.ground_radiance;
    return sky.zenith * static_cast<float>((1 + 2 * direction.y) / 3);
}

}  // namespace obscura
