// Where near fields stop being what one looked for: tables of optics/limits.md.

#include <gtest/gtest.h>

#include <cstdio>

#include "optics/near_field_colour.h"
#include "tests/optics/cases.h"
#include "tests/optics/near_field_oracle.h"

namespace obscura {
namespace {

using namespace diffraction_cases;
using near_field_oracle::at_fresnel_number;

TEST(NearFieldStability, FromTheFarFieldToTheShadow) {
    constexpr int size = 256;
    const Aperture disc = near_field_oracle::disc(size, 0.3 * size);
    double before = 1e9;
    for (const double number : {0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6}) {
        const NearFieldParams params = at_fresnel_number(disc, number);
        const PlaneGrid plane = centred_plane(size, size);
        NearFieldReport report;
        const Field field = near_field(disc, plane, params, Exec{}, &report);
        // Against double at a few points.
        const PlaneGrid few{16, 16, plane.first_x, plane.first_y, 16};
        const auto exact = near_field_oracle::exact_field(disc, few, params);
        double error = 0;
        for (int k = 0; k < 256; ++k) {
            const int x = k % 16 * 16, y = k / 16 * 16;
            const near_field_oracle::Complex ours(static_cast<double>(field.re(x, y)),
                                                  static_cast<double>(field.im(x, y)));
            error = std::max(error, std::abs(ours - exact(k % 16, k / 16)));
        }
        double rms = 0, brightest = 0;
        for (std::size_t i = 0; i < field.re.pixels.size(); ++i) {
            const double re = static_cast<double>(field.re.pixels[i]),
                         im = static_cast<double>(field.im.pixels[i]), intensity = re * re + im * im;
            brightest = std::max(brightest, intensity);
            rms += std::pow(intensity - static_cast<double>(disc.mask.pixels[i]), 2);
        }
        rms = std::sqrt(rms / size / size);
        std::printf("| %.0e | %.2f | %.1e | %.3f | %.2f | %s |\n", number, 0.5 * size / std::sqrt(number),
                    error, rms, brightest, near_field_method_name(report.method));
        EXPECT_LT(error, 2e-6) << number;
        if (number >= 100) {
            EXPECT_LT(rms, before) << "towards the shadow";
            before = rms;
        }
        if (number > 1e5) {
            EXPECT_LT(rms, 0.02);
        }
    }
}

TEST(NearFieldStability, FarFieldsBeginWellBelowOne) {
    constexpr int size = 128, side = 64;
    const Aperture a = binary_shape(ApertureKind::iris, size);
    for (const double number : {0.001, 0.01, 0.1, 1.0}) {
        const NearFieldParams params = at_fresnel_number(a, number);
        // A pixel off the axis, in texels and as a frequency: four samples per fringe.
        const double turns = number / (0.25 * size * size), step = 0.25 / size;
        const PlaneGrid plane{side, side, -0.5 * side * step / turns, -0.5 * side * step / turns,
                              step / turns};
        const Image<float> near = near_field_intensity(a, plane, params, Exec{}),
                           far = far_field_power(a, centred_grid(side, side, step), {}, Exec{});
        const double peak = std::pow(open_area(a.mask.view()), 2), scale = turns * turns;
        double worst = 0;
        for (std::size_t i = 0; i < far.pixels.size(); ++i)
            worst = std::max(worst, std::fabs(static_cast<double>(near.pixels[i]) / scale -
                                              static_cast<double>(far.pixels[i])) /
                                        peak);
        std::printf("| %5.3f | %.1e |\n", number, worst);
        EXPECT_LT(worst, 1.5 * number);
        EXPECT_GT(worst, 1e-3 * number * number);
    }
}

TEST(NearFieldStability, FringesNarrowerThanAPixelAlias) {
    // The mean over a pixel, by 8 x 8 samples of it, against the sample at its middle.
    const Aperture disc = near_field_oracle::disc(128, 40);
    for (const double number : {10.0, 100.0, 1e3, 1e4}) {
        const NearFieldParams params = at_fresnel_number(disc, number);
        const Image<float> middle = near_field_intensity(disc, centred_plane(128, 128), params, Exec{}),
                           fine = near_field_intensity(disc, centred_plane(1024, 128), params, Exec{});
        Image<float> mean(128, 128);
        for (int y = 0; y < 1024; ++y) {
            for (int x = 0; x < 1024; ++x)
                mean(x / 8, y / 8) += fine(x, y) / 64;
        }
        double worst = 0;
        for (std::size_t i = 0; i < mean.pixels.size(); ++i)
            worst = std::max(worst, static_cast<double>(std::fabs(mean.pixels[i] - middle.pixels[i])));
        std::printf("| %.0e | %.2f | %.4f | %.3f |\n", number, 64 / std::sqrt(number),
                    mean_relative(middle.view(), mean.view()), worst);
        if (number < 50) {
            EXPECT_LT(worst, 0.05);
        }
        if (number > 500) {
            EXPECT_GT(worst, 0.2);
        }
    }
}

TEST(NearFieldStability, CoarseMasksMoveEdges) {
    const Aperture a = binary_shape(ApertureKind::iris, 512);
    for (const double number : {1.0, 10.0, 100.0}) {
        NearFieldParams params = at_fresnel_number(a, number);
        const PlaneGrid plane = centred_plane(256, 512);
        const Image<float> truth = near_field_intensity(a, plane, params, Exec{});
        double before = 0;
        for (const int levels : {1, 2, 3}) {
            params.coarse_levels = levels;
            const Image<float> coarse = near_field_intensity(a, plane, params, Exec{});
            const double error = mean_relative(coarse.view(), truth.view());
            std::printf("| %3.0f | %d | %.4f |\n", number, levels, error);
            if (number > 5) {
                EXPECT_GT(error, before);
            }
            before = error;
        }
        EXPECT_LT(before, 0.012 * std::sqrt(number));
        EXPECT_GT(before, 0.002);
    }
}

TEST(NearFieldStability, ScaledColoursAreNotPhysics) {
    const Aperture a = binary_shape(ApertureKind::iris, 128);
    const LightSpectrum light;
    for (const double number : {0.3, 1.0, 5.0, 20.0, 100.0}) {
        const NearFieldParams params = at_fresnel_number(a, number);
        const PlaneGrid plane = centred_plane(128, 128);
        const auto colour = [&](NearFieldColour how) {
            return near_field_colour(a, plane, params, light, 24, how, Exec{});
        };
        const Image<Vec3f> exact = colour(NearFieldColour::exact), scaled = colour(NearFieldColour::scaled);
        NearFieldParams green = params;
        green.wavelength_m = 1e-9 * near_field_reference_nm;
        const Image<float> one = near_field_intensity(a, plane, green, Exec{});
        Image<Vec3f> grey(128, 128);
        for (std::size_t i = 0; i < one.pixels.size(); ++i)
            grey.pixels[i] = {one.pixels[i], one.pixels[i], one.pixels[i]};
        const double of_scaled = mean_relative(scaled, exact), of_grey = mean_relative(grey, exact);
        std::printf("| %5.1f | %.3f | %.3f |\n", number, of_scaled, of_grey);
        EXPECT_GT(of_scaled, 0.01) << "an approximation that deserves its label";
        EXPECT_LT(of_scaled, 1.0);
    }
}

}  // namespace
}  // namespace obscura
