// The overcast sky: its shape, its brightness, its dusk.

#include "core/sky/overcast_sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/num.h"
#include "core/observer.h"
#include "core/sky/air_spectrum.h"
#include "core/sky/clear_sky.h"
#include "core/sky/sky_directions.h"

namespace obscura {
namespace {

TEST(OvercastSky, IsThreeTimesAsBrightAboveAndHasNoSides) {
    const OvercastSky sky = overcast_sky(30, {5, 5, 5}, {0.2, 0.2, 0.2});
    const Vec3f up = sky_radiance(sky, {0, 1, 0}), level = sky_radiance(sky, {1, 0, 0});
    EXPECT_NEAR(up.x / level.x, 3, 1e-6);
    EXPECT_EQ(sky_radiance(sky, compass_direction(0, 30)).x,
              sky_radiance(sky, {-std::sqrt(0.75), num::sin_deg(30), 0}).x);
    EXPECT_NEAR(sky_radiance(sky, compass_direction(77, 30)).y / up.y, 2 / 3.0, 1e-6);
}

// Krochmann and Seidl 1974: 300 + 21000 sin(elevation) lx; a zenith of 8.6 sin + 0.123 kcd/m2 (CIE).
TEST(OvercastSky, IsAsBrightAsMeasured) {
    for (const double elevation : {0.0, 10.0, 35.0, 90.0}) {
        const OvercastSky sky = overcast_sky(elevation, sun_above_air_true(), {0.3, 0.3, 0.3});
        const double sine = num::sin_deg(elevation), lux = lux_per_watt();
        const Vec3d level =
            unoccluded_irradiance(sky_grid([&](Vec3d d) { return sky_radiance(sky, d); }, {}), {0, 1, 0});
        EXPECT_NEAR(srgb_luminance(level) * lux / (300 + 21000 * sine), 1, 1e-4);
        EXPECT_NEAR(srgb_luminance(to_double(sky.zenith)) * lux / (8600 * sine + 123), 1, 0.005);
        // Without a balance the clouds are white.
        EXPECT_NEAR(sky.zenith.x / sky.zenith.z, 1, 1e-6);
        EXPECT_NEAR(sky.ground_radiance.y, 0.3 * level.y / num::pi, 1e-4 * level.y);
    }
}

TEST(OvercastSky, FadesWithoutAStep) {
    const auto zenith = [](double elevation) {
        return overcast_sky(elevation, {5, 5, 5}, {0, 0, 0}).zenith.y;
    };
    EXPECT_NEAR(zenith(-1e-4) / zenith(0), 1, 1e-3);
    for (const double edge : {-0.8, -5.0, -12.0})
        EXPECT_NEAR(zenith(edge - 1e-4) / zenith(edge + 1e-4), 1, 0.03) << edge;
    float before = zenith(90);
    for (double elevation = 89; elevation >= -18; --elevation) {
        EXPECT_LT(zenith(elevation), before) << elevation;
        before = zenith(elevation);
    }
    EXPECT_EQ(zenith(-60), zenith(-18));
}

}  // namespace
}  // namespace obscura
