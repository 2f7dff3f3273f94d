// The clear sky against itself: tables against rays, few wavelengths against many, symmetry, energy, the
// disc.

#include "core/sky/clear_sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/num.h"
#include "core/observer.h"

namespace obscura {
namespace {

const Exec exec{};

ClearAir air_of(double turbidity, Vec3d albedo = {0.2, 0.2, 0.2}, int wavelengths = 10) {
    ClearAirParams params;
    params.turbidity = turbidity;
    params.ground_albedo = albedo;
    params.wavelengths = wavelengths;
    return clear_air(params, exec);
}

double largest(Vec3d c) {
    return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
}

/// Directions that avoid the nodes of the table, denser at the horizon, on one side of the sun.
template <class Fn>
void for_directions(double sun_azimuth_deg, Fn&& fn) {
    for (int i = 0; i < 24; ++i) {
        const double x = (i + 0.37) / 24;
        for (int j = 0; j < 13; ++j)
            fn(compass_direction(sun_azimuth_deg + 180 * (j + 0.41) / 13, 90 * x * x));
    }
}

struct Errors {
    double mean = 0, worst = 0;
};

TEST(ClearSky, TableIsTheRaysAndStepsAreEnough) {
    const ClearAir air = air_of(2.5);
    for (const double elevation : {50.0, 5.0, 0.0, -4.0, -8.0}) {
        const ClearSky sky = clear_sky(air, 20, elevation, exec);
        Errors table, steps;
        int count = 0;
        for_directions(20, [&](Vec3d direction) {
            const Vec3d direct = clear_sky_radiance_direct(sky, direction, 48);
            const double scale = 1 / largest(direct);
            const double error = largest(to_double(sky_radiance(sky, direction)) - direct) * scale;
            table.mean += error;
            table.worst = std::max(table.worst, error);
            ++count;
            if (count % 3 > 0) return;
            const Vec3d fine = clear_sky_radiance_direct(sky, direction, 300);
            steps.worst = std::max(steps.worst, largest(fine - direct) * scale);
        });
        EXPECT_LT(table.mean / count, 6e-4) << elevation;
        EXPECT_LT(table.worst, elevation > 0 ? 0.003 : 0.02) << elevation;
        EXPECT_LT(steps.worst, elevation > 10 ? 0.003 : 0.025) << elevation;
    }
}

TEST(ClearSky, TenWavelengthsAreForty) {
    const ClearAir few = air_of(2), many = air_of(2, {0.2, 0.2, 0.2}, 40);
    for (const double elevation : {60.0, 5.0, 0.0, -8.0}) {
        const ClearSky a = clear_sky(few, 0, elevation, exec), b = clear_sky(many, 0, elevation, exec);
        for (const Vec3d direction :
             {compass_direction(0, 1), compass_direction(0, 5), compass_direction(180, 10),
              compass_direction(90, 30), Vec3d{0, 1, 0}}) {
            const Vec3d x = to_double(sky_radiance(a, direction)), y = to_double(sky_radiance(b, direction));
            EXPECT_LT(largest(x - y), 0.012 * largest(y)) << elevation;
        }
        const Vec3d sun = to_double(a.sun_irradiance_w_m2), reference = to_double(b.sun_irradiance_w_m2);
        // A sun on the horizon is nothing but the far red.
        if (elevation > 0) {
            EXPECT_LT(largest(sun - reference), 0.012 * largest(reference)) << elevation;
        }
    }
}

TEST(ClearSky, LeftAndRightOfTheSunAreAlikeAndItTurnsWithTheSun) {
    const ClearAir air = air_of(3);
    const ClearSky sky = clear_sky(air, 110, 12, exec), turned = clear_sky(air, 335, 12, exec);
    for (const double off : {10.0, 70.0, 130.0}) {
        for (const double elevation : {0.5, 15.0, 60.0}) {
            const Vec3d left = to_double(sky_radiance(sky, compass_direction(110 - off, elevation)));
            const Vec3d right = to_double(sky_radiance(sky, compass_direction(110 + off, elevation)));
            const Vec3d other = to_double(sky_radiance(turned, compass_direction(335 + off, elevation)));
            EXPECT_LT(largest(left - right), 1e-5 * largest(left));
            EXPECT_LT(largest(other - right), 1e-5 * largest(left));
        }
    }
    // Whichever azimuth one comes from, there is one zenith.
    const Vec3d zenith = to_double(sky_radiance(sky, {0, 1, 0}));
    for (const double azimuth : {0.0, 100.0, 200.0})
        EXPECT_LT(largest(to_double(sky_radiance(sky, compass_direction(azimuth, 89.999))) - zenith),
                  1e-3 * largest(zenith));
}

TEST(ClearSky, EnergyIsLostOnly) {
    for (const double turbidity : {1.7, 5.0}) {
        const ClearAir black = air_of(turbidity, {0, 0, 0}), white = air_of(turbidity, {1, 1, 1});
        for (const double elevation : {20.0, 45.0, 90.0}) {
            const double sine = num::sin_deg(elevation), above = 5 * sine;
            const ClearSky sky = clear_sky(black, 0, elevation, exec);
            const Vec3d down = to_double(sky.sky_irradiance_w_m2) + to_double(sky.sun_irradiance_w_m2) * sine;
            for (const double channel : {down.x, down.y, down.z}) {
                EXPECT_LT(channel, above);
                EXPECT_GT(channel, 0.4 * above);
            }
            EXPECT_EQ(largest(to_double(sky.ground_radiance)), 0);
            // A white ground sends all back, some of which returns: more, but no more than a mirror above
            // would give.
            const ClearSky bright = clear_sky(white, 0, elevation, exec);
            const Vec3d more = to_double(bright.sky_irradiance_w_m2) - to_double(sky.sky_irradiance_w_m2);
            for (const double channel : {more.x, more.y, more.z}) {
                EXPECT_GT(channel, 0.05 * above);
                EXPECT_LT(channel, 0.6 * above);
            }
        }
    }
}

TEST(ClearSky, AColouredGroundColoursTheSkyALittle) {
    const ClearSky red = clear_sky(air_of(3, {0.6, 0.1, 0.1}), 0, 45, exec);
    const ClearSky blue = clear_sky(air_of(3, {0.1, 0.1, 0.6}), 0, 45, exec);
    const Vec3f a = sky_radiance(red, {0, 1, 0}), b = sky_radiance(blue, {0, 1, 0});
    EXPECT_GT(a.x, b.x * 1.01f);
    EXPECT_LT(a.z, b.z / 1.01f);
    EXPECT_GT(red.ground_radiance.x, 4 * red.ground_radiance.z);
    EXPECT_EQ(sky_radiance(red, compass_direction(40, -5)), red.ground_radiance);
}

TEST(ClearSky, TheDiscAddsUpToTheSun) {
    const ClearAir air = air_of(2);
    for (const double elevation : {40.0, 3.0, 0.1}) {
        const ClearSky sky = clear_sky(air, 200, elevation, exec);
        // Rings of the disc, in the tangent plane.
        const double radius = num::sin_deg(sun_radius_deg);
        const Vec3d side = normalize(cross(sky.towards_sun, {0, 1, 0})), up = cross(side, sky.towards_sun);
        Vec3d sum;
        const int cells = 96;
        for (int i = 0; i < cells; ++i) {
            for (int j = 0; j < cells; ++j) {
                const double x = 2.2 * radius * ((i + 0.5) / cells - 0.5),
                             y = 2.2 * radius * ((j + 0.5) / cells - 0.5);
                sum = sum + to_double(sun_disc_radiance(sky, normalize(sky.towards_sun + side * x + up * y)));
            }
        }
        sum = sum * (2.2 * radius * 2.2 * radius / (cells * cells));
        const Vec3d sun = to_double(sky.sun_irradiance_w_m2);
        EXPECT_LT(largest(sum - sun), 0.03 * largest(sun)) << elevation;
    }
    const ClearSky sky = clear_sky(air, 200, 40, exec);
    EXPECT_EQ(sun_disc_radiance(sky, compass_direction(200, 40.3)), Vec3f{});
    EXPECT_EQ(sun_disc_radiance(sky, -sky.towards_sun), Vec3f{});
    // The limb is darker, and redder.
    const Vec3f middle = sun_disc_radiance(sky, sky.towards_sun),
                limb = sun_disc_radiance(sky, compass_direction(200, 40.25));
    EXPECT_LT(limb.y, 0.7f * middle.y);
    EXPECT_GT(limb.x / limb.z, 1.05f * middle.x / middle.z);
}

TEST(ClearSky, TheSunReddensAndSets) {
    const AirSpectrum air = air_spectrum(2, {5, 5, 5}, 10);
    Vec3f before = sun_irradiance(air, 90);
    EXPECT_GT(before.x, before.y);
    EXPECT_GT(before.y, before.z);
    for (const double elevation : {60.0, 30.0, 15.0, 8.0, 5.0, 2.0, 0.2, 0.0, -0.2}) {
        const Vec3f sun = sun_irradiance(air, elevation);
        EXPECT_LT(sun.x, before.x);
        EXPECT_LE(sun.z / sun.x, before.z / before.x);
        before = sun;
    }
    EXPECT_GT(before.x, 0);
    EXPECT_EQ(sun_irradiance(air, -0.27), Vec3f{});
    const Vec3f low = sun_irradiance(air, 5);
    EXPECT_LT(low.z, 0.15f * low.x);
}

}  // namespace
}  // namespace obscura
