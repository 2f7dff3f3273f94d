// Light and the observer against the CIE's own table, published fits and what must hold for any light.

#include "optics/spectrum.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace obscura {
namespace {

/// CIE 1931 2-degree observer at 10 nm, from 380 nm (CIE 15:2004, table T.4).
constexpr std::array<Vec3d, 41> cie_1931 = {{
    {0.001368, 0.000039, 0.006450}, {0.004243, 0.000120, 0.020050}, {0.014310, 0.000396, 0.067850},
    {0.043510, 0.001210, 0.207400}, {0.134380, 0.004000, 0.645600}, {0.283900, 0.011600, 1.385600},
    {0.348280, 0.023000, 1.747060}, {0.336200, 0.038000, 1.772110}, {0.290800, 0.060000, 1.669200},
    {0.195360, 0.090980, 1.287640}, {0.095640, 0.139020, 0.812950}, {0.032010, 0.208020, 0.465180},
    {0.004900, 0.323000, 0.272000}, {0.009300, 0.503000, 0.158200}, {0.063270, 0.710000, 0.078250},
    {0.165500, 0.862000, 0.042160}, {0.290400, 0.954000, 0.020300}, {0.433450, 0.994950, 0.008750},
    {0.594500, 0.995000, 0.003900}, {0.762100, 0.952000, 0.002100}, {0.916300, 0.870000, 0.001650},
    {1.026300, 0.757000, 0.001100}, {1.062200, 0.631000, 0.000800}, {1.002600, 0.503000, 0.000340},
    {0.854450, 0.381000, 0.000190}, {0.642400, 0.265000, 0.000050}, {0.447900, 0.175000, 0.000020},
    {0.283500, 0.107000, 0.000000}, {0.164900, 0.061000, 0.000000}, {0.087400, 0.032000, 0.000000},
    {0.046770, 0.017000, 0.000000}, {0.022700, 0.008210, 0.000000}, {0.011359, 0.004102, 0.000000},
    {0.005790, 0.002091, 0.000000}, {0.002899, 0.001047, 0.000000}, {0.001440, 0.000520, 0.000000},
    {0.000690, 0.000249, 0.000000}, {0.000332, 0.000120, 0.000000}, {0.000166, 0.000060, 0.000000},
    {0.000083, 0.000030, 0.000000}, {0.000042, 0.000015, 0.000000},
}};

double wavelength_of(std::size_t row) {
    return shortest_visible_nm + 10 * static_cast<double>(row);
}

Vec2d chromaticity(Vec3d xyz) {
    const double sum = xyz.x + xyz.y + xyz.z;
    return {xyz.x / sum, xyz.y / sum};
}

void expect_near(Vec3d a, Vec3d b, double within) {
    EXPECT_NEAR(a.x, b.x, within);
    EXPECT_NEAR(a.y, b.y, within);
    EXPECT_NEAR(a.z, b.z, within);
}

TEST(Observer, FollowsTheStandardsTable) {
    Vec3d squares, worst;
    for (std::size_t row = 0; row < cie_1931.size(); ++row) {
        const Vec3d fit = observer_xyz(wavelength_of(row)), error = fit - cie_1931[row];
        EXPECT_GE(fit.x, 0);
        squares = squares + error * error;
        worst = {std::max(worst.x, std::fabs(error.x)), std::max(worst.y, std::fabs(error.y)),
                 std::max(worst.z, std::fabs(error.z))};
    }
    EXPECT_LT(worst.x, 0.014);
    EXPECT_LT(worst.y, 0.0075);
    EXPECT_LT(worst.z, 0.0135);
    EXPECT_LT(std::sqrt(squares.x / 41), 0.0065);
    EXPECT_LT(std::sqrt(squares.y / 41), 0.0035);
    EXPECT_LT(std::sqrt(squares.z / 41), 0.0040);
}

TEST(Observer, SeesDaylightWhiteBeforeAnyScaling) {
    Vec3d fitted, standard;
    for (int nm = 380; nm <= 780; ++nm)
        fitted = fitted + observer_xyz(nm) * spectral_power({LightSource::d65}, nm);
    for (std::size_t row = 0; row < cie_1931.size(); ++row)
        standard = standard + cie_1931[row] * spectral_power({LightSource::d65}, wavelength_of(row));
    // The table of D65 that is built in, seen by the standard's observer: the standard's white.
    EXPECT_NEAR(chromaticity(standard).x, 0.31273, 3e-5);
    EXPECT_NEAR(chromaticity(standard).y, 0.32902, 1.5e-4);
    // The fit's white, in XYZ and in sRGB.
    expect_near(fitted * (1 / fitted.y), xyz_from_srgb({1, 1, 1}), 1.3e-3);
    expect_near(srgb_from_xyz(fitted * (1 / fitted.y)), {1, 1, 1}, 2.5e-3);
}

TEST(Light, DaylightIsWhite) {
    expect_near(srgb_from_xyz(light_xyz({LightSource::d65})), {1, 1, 1}, 1e-12);
}

TEST(Light, EqualEnergyLiesAtOneThird) {
    const Vec2d at = chromaticity(light_xyz({LightSource::equal}));
    EXPECT_NEAR(at.x, 1.0 / 3, 1e-3);
    EXPECT_NEAR(at.y, 1.0 / 3, 1e-3);
}

TEST(Light, BlackbodiesFollowThePlanckianLocus) {
    // Kim et al., US patent 7024034 (2002): cubic splines for the locus.
    for (const double kelvin : {2000.0, 2856.0, 3500.0, 4500.0, 6504.0, 10000.0, 20000.0}) {
        const double i = 1e3 / kelvin;
        const double x = kelvin < 4000 ? ((-0.2661239 * i - 0.2343589) * i + 0.8776956) * i + 0.179910
                                       : ((-3.0258469 * i + 2.1070379) * i + 0.2226347) * i + 0.240390;
        const double y = kelvin < 2222   ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
                         : kelvin < 4000 ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
                                         : ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
        const Vec2d at = chromaticity(light_xyz({LightSource::blackbody, kelvin}));
        // The fit of the observer is off by 0.0026 at 2000 K, by less elsewhere.
        EXPECT_NEAR(at.x, x, 3e-3) << kelvin << " K";
        EXPECT_NEAR(at.y, y, 3e-3) << kelvin << " K";
    }
    // Wien's displacement: 2.8978e6 nm K over 5000 K is 579.6 nm.
    const LightSpectrum warm{LightSource::blackbody, 5000};
    EXPECT_GT(spectral_power(warm, 579.6), spectral_power(warm, 575));
    EXPECT_GT(spectral_power(warm, 579.6), spectral_power(warm, 584));
}

TEST(Light, SodiumIsOrange) {
    const Vec2d at = chromaticity(light_xyz({LightSource::sodium}));
    EXPECT_NEAR(at.x, 0.569, 2.5e-3);
    EXPECT_NEAR(at.y, 0.430, 2.5e-3);
    EXPECT_EQ(spectral_samples({LightSource::sodium}, 60).size(), 2u);
    EXPECT_EQ(spectral_samples({LightSource::sodium}, 1).size(), 1u);
}

TEST(Light, LinesHaveTheirStatedPowerAndWidth) {
    double first = 0, second = 0;
    for (int i = -500; i < 1500; ++i) {
        const double nm = 589 + 0.001 * i, power = spectral_power({LightSource::sodium}, nm);
        (nm < 589.29 ? first : second) += power;
    }
    EXPECT_NEAR(first / second, 2, 1e-3);
    EXPECT_NEAR(
        spectral_power({LightSource::sodium}, 589.045) / spectral_power({LightSource::sodium}, 588.995),
        std::exp(-0.5), 1e-6);
    EXPECT_LT(spectral_power({LightSource::sodium}, 590.2), 1e-12);
}

TEST(Light, DiodesMixToWhite) {
    expect_near(srgb_from_xyz(light_xyz({LightSource::rgb_led})), {1, 1, 1}, 1e-4);
    const LightSpectrum led{LightSource::rgb_led};
    EXPECT_NEAR(spectral_power(led, 630 + 9) / spectral_power(led, 630), 0.5, 1e-6);
    EXPECT_LT(spectral_power(led, 580), 0.01 * spectral_power(led, 525));
}

TEST(Samples, AddUpToTheLight) {
    for (const LightSource source : {LightSource::d65, LightSource::equal, LightSource::blackbody,
                                     LightSource::sodium, LightSource::rgb_led, LightSource::monochromatic}) {
        const LightSpectrum light{source, 3000, 530};
        for (const int count : {1, 2, 3, 7, 15, 60, 240}) {
            const auto samples = spectral_samples(light, count);
            ASSERT_FALSE(samples.empty());
            EXPECT_LE(samples.size(), static_cast<std::size_t>(count));
            Vec3d xyz, rgb;
            for (std::size_t i = 0; i < samples.size(); ++i) {
                xyz = xyz + samples[i].xyz;
                rgb = rgb + samples[i].rgb;
                EXPECT_GT(samples[i].wavelength_nm, i == 0 ? 380 : samples[i - 1].wavelength_nm);
                EXPECT_LT(samples[i].wavelength_nm, 780);
            }
            expect_near(xyz, light_xyz(light), 1e-12);
            expect_near(rgb, srgb_from_xyz(xyz), 1e-12);
            EXPECT_NEAR(srgb_luminance(rgb), 1, 1e-12);
        }
    }
}

TEST(Samples, IntegrateWhatVariesSmoothly) {
    // The colour of light whose every wavelength is dimmed by (wavelength / 560)^-4, as the sky does.
    const auto blue_sky = [](int count) {
        Vec3d sum;
        for (const SpectralSample& sample : spectral_samples({LightSource::d65}, count))
            sum = sum + sample.rgb * std::pow(560 / sample.wavelength_nm, 4);
        return sum;
    };
    const Vec3d exact = blue_sky(4000);
    EXPECT_GT(exact.z, 1.5 * exact.x);
    expect_near(blue_sky(60), exact, 1e-3);
    expect_near(blue_sky(15), exact, 2e-2);
}

TEST(Samples, LightsWithGapsUseFewer) {
    EXPECT_LT(spectral_samples({LightSource::rgb_led}, 100).size(), 95u);
    EXPECT_EQ(spectral_samples({LightSource::d65}, 100).size(), 100u);
}

TEST(Samples, TheRateResolvesFringes) {
    // A fringe cos^2 that passes `cycles` times while 550 / wavelength grows by 1.
    const auto seen = [](const LightSpectrum& light, double cycles, int count) {
        Vec3d sum;
        for (const SpectralSample& sample : spectral_samples(light, count))
            sum = sum + sample.xyz * (1 + std::cos(2 * M_PI * cycles * 550 / sample.wavelength_nm));
        return sum;
    };
    for (const LightSource source :
         {LightSource::d65, LightSource::equal, LightSource::blackbody, LightSource::rgb_led}) {
        const LightSpectrum light{source, 2800};
        for (const double tolerance : {0.03, 0.01}) {
            for (const double most : {0.0, 3.0, 40.0, 300.0}) {
                const int count = spectral_rate(light, most, tolerance).count;
                double worst = 0;
                for (double cycles = 0; cycles <= most; cycles += std::max(0.5, most / 150)) {
                    const Vec3d error = seen(light, cycles, count) - seen(light, cycles, 2000);
                    worst = std::max({worst, std::fabs(error.x), std::fabs(error.y), std::fabs(error.z)});
                }
                EXPECT_LT(worst, tolerance) << static_cast<int>(source) << " " << most << " " << count;
            }
        }
    }
    // Too few samples make light of fringes that no eye would see: the rule is needed.
    const LightSpectrum day{LightSource::d65};
    const SpectralRate rate = spectral_rate(day, 300, 0.01);
    const int half = rate.count / 2;
    const double beat = half / (rate.largest_scale - rate.least_scale);
    EXPECT_LT(std::fabs(seen(day, beat, rate.count).y - 1), 0.01);
    EXPECT_GT(std::fabs(seen(day, beat, half).y - 1), 0.5);
    EXPECT_EQ(spectral_rate({LightSource::sodium}, 300, 0.01).count, 2);
}

TEST(Gamut, MatricesAreInverse) {
    for (const Vec3d rgb : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}, Vec3d{0.2, 0.7, 1.4}})
        expect_near(srgb_from_xyz(xyz_from_srgb(rgb)), rgb, 1e-14);
    EXPECT_NEAR(chromaticity(xyz_from_srgb({1, 0, 0})).x, 0.64, 1e-4);
    EXPECT_NEAR(chromaticity(xyz_from_srgb({0, 1, 0})).y, 0.60, 1e-4);
    EXPECT_NEAR(chromaticity(xyz_from_srgb({0, 0, 1})).x, 0.15, 1e-4);
}

TEST(Gamut, MappingKeepsLuminanceAndHue) {
    for (int nm = 400; nm <= 700; nm += 5) {
        const Vec3d rgb = srgb_from_xyz(observer_xyz(nm)), in = into_gamut(rgb);
        EXPECT_GE(std::min({in.x, in.y, in.z}), 0) << nm;
        EXPECT_NEAR(srgb_luminance(in), srgb_luminance(rgb), 1e-12) << nm;
        // On the line from the colour to grey: differences of channels keep their proportion.
        EXPECT_NEAR((in.x - in.y) * (rgb.y - rgb.z), (in.y - in.z) * (rgb.x - rgb.y), 1e-12) << nm;
    }
    const Vec3d inside{0.1, 0, 3};
    EXPECT_EQ(into_gamut(inside), inside);
    EXPECT_EQ(into_gamut({-1, 0, 0}), Vec3d{});
    EXPECT_EQ(into_gamut({}), Vec3d{});
}

}  // namespace
}  // namespace obscura
