// Profiles, air masses, optical depths and the sun's spectrum against quadrature and published values.

#include "core/sky/air.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/num.h"
#include "core/observer.h"
#include "core/sky/air_spectrum.h"
#include "core/sky/exp_lanes.h"
#include "core/sky/scattered_light.h"

namespace obscura {
namespace {

TEST(ExpOfDepth, IsTheExponential) {
    for (double x = 0; x > -700; x -= 0.3731)
        EXPECT_NEAR(exp_of_depth(x) / num::exp(x), 1, 1e-13) << x;
    EXPECT_EQ(exp_of_depth(0), 1);
}

TEST(Air, EachProfileIsOneColumn) {
    AirAmount sum;
    const double step = 0.005;
    for (double height = step / 2; height < air_top_km; height += step)
        sum = sum + air_density(height) * step;
    EXPECT_NEAR(sum.molecules, 1, 1e-5);
    EXPECT_NEAR(sum.aerosol, 1, 1e-5);
    EXPECT_NEAR(sum.ozone, 1, 1e-5);
}

// Every second row of the standard atmosphere, 1 kg/m3 of air at sea level.
TEST(Air, MoleculesThinOutAsTheStandardAtmosphereDoes) {
    const double ground = air_density(0).molecules;
    EXPECT_NEAR(air_density(1).molecules / ground, 1.1117 / 1.2250, 2e-3);
    EXPECT_NEAR(air_density(11).molecules / ground, 0.36480 / 1.2250, 1e-12);
    EXPECT_NEAR(air_density(35).molecules / ground, 8.4634e-3 / 1.2250, 2e-4);
    // Weight of the column over its density: 101325 Pa / (9.80665 m/s2 * 1.2250 kg/m3).
    EXPECT_NEAR(1 / ground, 8.435, 0.05);
}

TEST(Air, RaysEndOnTheGroundOrAtTheTop) {
    EXPECT_TRUE(ray_end(10, -1).on_ground);
    EXPECT_NEAR(ray_end(10, -1).distance_km, 10, 1e-9);
    EXPECT_NEAR(ray_end(10, 1).distance_km, air_top_km - 10, 1e-9);
    EXPECT_NEAR(ray_end(0, 0).distance_km, std::sqrt(air_top_km * (air_top_km + 2 * earth_radius_km)), 1e-6);
    // From 10 km the horizon lies 3.2 degrees below level.
    EXPECT_FALSE(ray_end(10, -num::sin_deg(3.1)).on_ground);
    EXPECT_TRUE(ray_end(10, -num::sin_deg(3.3)).on_ground);
}

// F. Kasten, A. Young 1989, which counts the air's refraction in: 1 % above 5 degrees, more below.
TEST(Air, MoleculesAreTheAirMassOfKastenAndYoung) {
    for (const double elevation : {90.0, 60.0, 30.0, 20.0, 10.0, 7.0, 5.0, 3.0, 1.0}) {
        const double published =
            1 / (num::sin_deg(elevation) + 0.50572 * num::pow(elevation + 6.07995, -1.6364));
        const double ours = air_to_space(0, num::sin_deg(elevation)).molecules;
        EXPECT_NEAR(ours / published, 1, elevation >= 5 ? 0.012 : 0.05) << elevation;
    }
}

TEST(Air, TableIsTheQuadrature) {
    AirAmount worst;
    double worst_low_aerosol = 0;
    for (const double height : {0.0, 0.05, 0.3, 0.7, 1.3, 2.2, 4.1, 7.3, 18.0, 27.0}) {
        for (int k = -60; k <= 100; k += 2) {
            const double cosine = k < 60 ? k * 0.0025 : 0.15 + (k - 60) * 0.02125;
            const RayEnd end = ray_end(height, cosine);
            if (end.on_ground) continue;
            const AirAmount table = air_to_space(height, cosine);
            // Even steps of about 1 km: slow and plain.
            AirAmount sum;
            const int steps = 1000;
            for (int i = 0; i < steps; ++i)
                sum = sum + air_along(height, cosine, end.distance_km * i / steps,
                                      end.distance_km * (i + 1) / steps);
            // What is no part of 1e-3 columns dims nothing.
            const auto error = [](double a, double b) { return std::abs(a - b) / std::max(b, 1e-3); };
            worst.molecules = std::max(worst.molecules, error(table.molecules, sum.molecules));
            worst.aerosol = std::max(worst.aerosol, error(table.aerosol, sum.aerosol));
            if (height < 2.5) worst_low_aerosol = worst.aerosol;
            worst.ozone = std::max(worst.ozone, error(table.ozone, sum.ozone));
        }
    }
    EXPECT_LT(worst.molecules, 0.004);
    EXPECT_LT(worst_low_aerosol, 0.003);
    EXPECT_LT(worst.aerosol, 0.05);
    EXPECT_LT(worst.ozone, 0.009);
}

TEST(Air, SunsDiscSetsSmoothly) {
    EXPECT_EQ(sun_share(0, num::sin_deg(0.3)), 1);
    EXPECT_NEAR(sun_share(0, 0), 0.5, 1e-12);
    EXPECT_EQ(sun_share(0, num::sin_deg(-0.3)), 0);
    EXPECT_NEAR(sun_share(10, -std::sin(std::acos(6371 / 6381.0))), 0.5, 1e-9);
}

// OPAC's continental average at 550 nm: mean cosine 0.703 (M. Hess, P. Koepke, I. Schult 1998).
TEST(Air, PhaseFunctionsAreNormal) {
    double molecules = 0, aerosol = 0, mean_cosine = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double cosine = 2 * (i + 0.5) / steps - 1;
        molecules += molecules_phase(cosine) / steps;
        aerosol += aerosol_phase(cosine) / steps;
        mean_cosine += aerosol_phase(cosine) * cosine / steps;
    }
    EXPECT_NEAR(molecules, 1, 1e-6);
    EXPECT_NEAR(aerosol, 1, 1e-6);
    EXPECT_NEAR(mean_cosine, 0.703, 1e-5);
}

TEST(AirSpectrum, OpticalDepthsArePublishedOnes) {
    const AirSpectrum air = air_spectrum(3, {1, 1, 1}, 10);
    EXPECT_NEAR(air.wavelength_nm[3], 500, 1e-9);
    EXPECT_NEAR(air.molecules[3], 0.1427, 0.001);  // Bodhaine et al. 1999, at 500 nm and sea level
    EXPECT_NEAR(air.molecules[0] / air.molecules[3], std::pow(500 / 420.0, 4.1), 0.03);
    EXPECT_NEAR(air.aerosol[3], (0.04608 * 3 - 0.04586) * std::pow(0.5, -1.3), 1e-12);
    // The Chappuis band: 4 % of a vertical ray's orange, nothing of its blue.
    EXPECT_NEAR(*std::max_element(air.ozone.begin(), air.ozone.end()), 0.039, 0.003);
    EXPECT_LT(air.ozone[0], 0.001);
}

TEST(AirSpectrum, TheSunAboveTheAirIsAsBrightAndAsWhiteAsPublished) {
    // Solar illuminance constant: 133.3 klx (S. Darula, R. Kittler, C. Gueymard 2005).
    EXPECT_NEAR(srgb_luminance(sun_above_air_true()), 1361 / 3.0, 1e-9);
    EXPECT_NEAR(lux_per_watt() * 1361 / 3, 133.3e3, 1.3e3);
    const Vec3d xyz = xyz_from_srgb(sun_above_air_true());
    const double sum = xyz.x + xyz.y + xyz.z, n = (xyz.x / sum - 0.3320) / (0.1858 - xyz.y / sum);
    EXPECT_NEAR(((449 * n + 3525) * n + 6823.3) * n + 5520.33, 5900, 100);  // kelvin, by McCamy 1992
    // Whatever the number of wavelengths, light that is all of the sun's has the colour asked for.
    for (const int count : {4, 10, 40}) {
        const AirSpectrum air = air_spectrum(2, {5, 4, 3}, count);
        Spectrum one;
        one.fill(1);
        EXPECT_NEAR(rgb_of(air, one).x, 5, 1e-9);
        EXPECT_NEAR(rgb_of(air, one).z, 3, 1e-9);
    }
}

TEST(AirSpectrum, ReflectanceIsFlatInEachChannel) {
    const AirSpectrum air = air_spectrum(2, {1, 1, 1}, 40);
    const Spectrum s = reflectance(air, {0.9, 0.5, 0.1}), grey = reflectance(air, {0.3, 0.3, 0.3});
    for (std::size_t i = 0; i < 40; ++i) {
        EXPECT_GE(s[i], 0.1);
        EXPECT_LE(s[i], 0.9);
        EXPECT_NEAR(grey[i], 0.3, 1e-15);
    }
    EXPECT_EQ(s[0], 0.1);
    EXPECT_NEAR(s[39], 0.9, 1e-15);
}

}  // namespace
}  // namespace obscura
