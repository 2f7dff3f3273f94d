// Near fields against what optics knows of them: knife edge, slit, Poisson's spot, Babinet, the far field as
// z grows, the geometric shadow as it falls.

#include <gtest/gtest.h>

#include <cmath>

#include "optics/aperture_shapes.h"
#include "optics/near_field.h"
#include "tests/optics/near_field_oracle.h"

namespace obscura {
namespace {

using namespace near_field_oracle;

constexpr double pi = 3.14159265358979323846;

/// Distance at which `texels` texels are one unit of the Fresnel integrals.
NearFieldParams at_unit(const Aperture& a, double texels) {
    NearFieldParams params;
    const double unit_m = texels * a.pitch_m;
    params.distance_m = 2 * unit_m * unit_m / params.wavelength_m;
    return params;
}

/// A half plane: the other sides of the mask are thousands of units away and disturb by 1e-3.
TEST(NearFieldPhysics, KnifeEdge) {
    const Aperture a = aperture_where(4096, 8, [](double x, double) { return x > -1024; });
    const double unit = 2;
    NearFieldParams params = at_unit(a, unit);
    const PlaneGrid line{192, 1, -1024 - 8, 0, 0.125};
    // Only 8 rows: divide by what they let through alone.
    const Aperture open = aperture_where(4096, 8, [](double, double) { return true; });
    const double rows = std::abs(exact_field(open, {1, 1, 0, 0, 1}, params)(0, 0));
    for (const NearFieldMethod method :
         {NearFieldMethod::edges, NearFieldMethod::hybrid, NearFieldMethod::fft}) {
        params.method = method;
        const Image<float> power = near_field_intensity(a, line, params, {});
        const auto at = [&](double units) {
            return static_cast<double>(power(64 + static_cast<int>(std::lround(8 * units * unit)), 0)) /
                   (rows * rows);
        };
        EXPECT_NEAR(at(0), 0.25, 4e-3);
        double brightest = 0;
        for (double units = 0.5; units < 2; units += 0.125 / unit)
            brightest = std::max(brightest, at(units));
        EXPECT_NEAR(brightest, 1.370, 4e-3);  // at w = 1.217
        EXPECT_NEAR(at(1.1875), 1.370, 8e-3);
        EXPECT_NEAR(at(1.875), 0.778, 4e-3);
        EXPECT_NEAR(at(-4), 1 / (2 * pi * pi * 16), 4e-4);  // tail of Cornu's spiral
    }
}

TEST(NearFieldPhysics, SlitIsTheChordOfCornusSpiral) {
    const Aperture a = aperture_where(512, 64, [](double x, double) { return std::fabs(x) < 40; });
    const Aperture all = aperture_where(512, 64, [](double, double) { return true; });
    const NearFieldParams params = at_unit(a, 23);
    const PlaneGrid line{257, 1, -128, 0, 1};
    const double rows = std::abs(exact_field(a, {1, 1, 0, 0, 1}, params)(0, 0));
    const Image<float> power = near_field_intensity(a, line, params, {});
    const auto chord = [](double x) {
        const FresnelValue v = fresnel_integral((40 - x) / 23.0), w = fresnel_integral((-40 - x) / 23.0);
        return 0.5 * ((v.c - w.c) * (v.c - w.c) + (v.s - w.s) * (v.s - w.s));
    };
    const double scale = rows * rows / chord(0);
    for (int i = 0; i < 257; ++i)
        EXPECT_NEAR(static_cast<double>(power(i, 0)), scale * chord(i - 128), 4e-6) << i;
}

Complex axis_value(const Aperture& a, const NearFieldParams& params) {
    const Field f = near_field(a, {1, 1, 0, 0, 1}, params, {});
    return {static_cast<double>(f.re(0, 0)), static_cast<double>(f.im(0, 0))};
}

Aperture covered_circle(int size, double radius) {
    ApertureShape shape;
    shape.kind = ApertureKind::circle;
    shape.diameter = 2 * radius / size;
    return make_aperture(shape, size, 2 * radius * 1e-5);
}

/// U = 1 - e^(i pi a^2 / (lambda z)) on the axis: bright for odd Fresnel numbers, dark for even ones.
TEST(NearFieldPhysics, AxisOfACircle) {
    const double radius = 240;
    const Aperture a = covered_circle(512, radius);
    for (const double number : {0.1, 0.5, 1.0, 1.5, 2.0, 4.0, 7.3}) {
        NearFieldParams params;
        params.distance_m = radius * radius * a.pitch_m * a.pitch_m / (params.wavelength_m * number);
        const Complex expected = 1.0 - std::polar(1.0, pi * number);
        // Texels blur the rim: a box of a texel on a phase of 2 pi N / radius per texel.
        const double blur = 2 * pi * number / radius;
        EXPECT_LT(std::abs(axis_value(a, params) - expected), 1.1 * blur * blur / 12 + 2e-6) << number;
    }
}

/// Behind a disc the rest of the wave comes together on the axis, as bright as if there were no disc.
TEST(NearFieldPhysics, PoissonsSpot) {
    const double radius = 120;
    const Aperture hole = covered_circle(512, radius);
    Aperture disc_in_square = hole;
    for (float& v : disc_in_square.mask.pixels)
        v = 1 - v;
    const Aperture square = aperture_where(
        512, 512, [](double, double) { return true; }, hole.pitch_m);
    for (const double number : {1.0, 2.0, 5.0, 10.0}) {
        NearFieldParams params;
        params.distance_m = radius * radius * hole.pitch_m * hole.pitch_m / (params.wavelength_m * number);
        // What would come from outside the mask's square: 1 less the square.
        const Complex outside = 1.0 - exact_field(square, {1, 1, 0, 0, 1}, params)(0, 0);
        const double blur = 2 * pi * number / radius;
        EXPECT_NEAR(std::norm(axis_value(disc_in_square, params) + outside), 1, blur * blur / 5) << number;
        // A shadow surrounds it.
        const Field beside = near_field(disc_in_square, {1, 1, 60, 13, 1}, params, {});
        const Complex u(static_cast<double>(beside.re(0, 0)), static_cast<double>(beside.im(0, 0)));
        const Complex more = 1.0 - exact_field(square, {1, 1, 60, 13, 1}, params)(0, 0);
        if (number >= 5) {
            EXPECT_LT(std::norm(u + more), 0.1) << number;
        }
    }
}

TEST(NearFieldPhysics, Babinet) {
    const Aperture a = blades(96, 80);
    Aperture rest = a, all = a;
    for (float& v : rest.mask.pixels)
        v = 1 - v;
    for (float& v : all.mask.pixels)
        v = 1;
    const NearFieldParams params = at_fresnel_number(a, 12);
    const PlaneGrid grid = centred_plane(96, 110);
    const Field u = near_field(a, grid, params, {}), v = near_field(rest, grid, params, {}),
                w = near_field(all, grid, params, {});
    for (std::size_t i = 0; i < w.re.pixels.size(); ++i) {
        EXPECT_NEAR(u.re.pixels[i] + v.re.pixels[i], w.re.pixels[i], 3e-6f);
        EXPECT_NEAR(u.im.pixels[i] + v.im.pixels[i], w.im.pixels[i], 3e-6f);
    }
}

/// F(u, v) of the mask, by its definition.
Complex fourier(const Aperture& a, double u, double v) {
    const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(pi * x) / (pi * x); };
    Complex sum;
    for (int y = 0; y < a.mask.height; ++y) {
        for (int x = 0; x < a.mask.width; ++x) {
            if (a.mask(x, y) == 0) continue;
            sum += std::polar(
                static_cast<double>(a.mask(x, y)),
                -2 * pi * (u * (x + 0.5 - 0.5 * a.mask.width) + v * (y + 0.5 - 0.5 * a.mask.height)));
        }
    }
    return sum * sinc(u) * sinc(v);
}

/// |U| goes to |F(x' / (lambda z), y' / (lambda z))| / (lambda z), the faster the farther: what is left of
/// the chirp over the aperture is a phase of pi NF at most.
TEST(NearFieldPhysics, BecomesTheFarField) {
    const Aperture a = blades(48, 48);
    double before = 1;
    for (const double number : {1.0, 0.1, 0.01, 1e-3, 1e-5, 1e-9, 1e-12, 1e-20}) {
        NearFieldParams params = at_fresnel_number(a, number);
        // lambda z in texels^2; pixels at multiples of 1 / 96 cycle per texel.
        const double area = params.wavelength_m * params.distance_m / (a.pitch_m * a.pitch_m);
        for (const NearFieldMethod method : {NearFieldMethod::edges, NearFieldMethod::hybrid}) {
            params.method = method;
            // Convolution needs a step of whole texels, and few enough of them.
            double step = area / 96;
            if (method == NearFieldMethod::hybrid) step = std::floor(step);
            if (method == NearFieldMethod::hybrid && !(step >= 1 && step < 1000)) continue;
            const PlaneGrid grid{17, 17, -8 * step, -8 * step, step};
            const Field f = near_field(a, grid, params, {});
            double largest = 0, peak = 0;
            for (int j = 0; j < 17; ++j) {
                for (int i = 0; i < 17; ++i) {
                    const double far =
                        std::abs(fourier(a, (i - 8) * step / area, (j - 8) * step / area)) / area;
                    const double near =
                        std::hypot(static_cast<double>(f.re(i, j)), static_cast<double>(f.im(i, j)));
                    largest = std::max(largest, std::fabs(near - far));
                    peak = std::max(peak, far);
                }
            }
            EXPECT_LT(largest / peak, std::max(0.6 * number, 2e-6)) << number;
            EXPECT_LT(largest / peak, std::max(1.01 * before, 2e-6)) << number;
            if (method == NearFieldMethod::edges) before = largest / peak;
        }
    }
}

/// A hair behind the mask only its shadow is there, but for pixels at its edges.
TEST(NearFieldPhysics, BecomesTheGeometricShadow) {
    const Aperture a = blades(64, 64);
    for (const double number : {1e5, 1e8, 1e12}) {
        NearFieldParams params = at_fresnel_number(a, number);
        for (const NearFieldMethod method :
             {NearFieldMethod::edges, NearFieldMethod::hybrid, NearFieldMethod::fft}) {
            params.method = method;
            const Image<float> power = near_field_intensity(a, centred_plane(64, 64), params, {});
            // Pixels stand in the middle of texels; edges reach 1 / (pi w) of the amplitude, w = sqrt(2 NF)
            // / 64.
            const double w = std::sqrt(2 * number) / 64;
            for (std::size_t i = 0; i < power.pixels.size(); ++i)
                EXPECT_NEAR(power.pixels[i], a.mask.pixels[i], 3 / w) << number;
        }
    }
}

}  // namespace
}  // namespace obscura
