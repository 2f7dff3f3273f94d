// Every strategy for near fields against the sum over texels in double, on every kind of plane.

#include "optics/near_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/image_io.h"
#include "tests/core/shared_folder.h"
#include "tests/optics/near_field_oracle.h"

namespace obscura {
namespace {

using namespace near_field_oracle;

constexpr NearFieldMethod all_methods[] = {NearFieldMethod::direct, NearFieldMethod::two_pass,
                                           NearFieldMethod::edges, NearFieldMethod::hybrid,
                                           NearFieldMethod::fft};

/// Largest error of every method: 2e-6 of the unobstructed amplitude, and of the pattern's own peak where
/// that is smaller.
void expect_exact(const Aperture& a, const PlaneGrid& grid, const NearFieldParams& params,
                  const std::string& what) {
    const Plane exact = exact_field(a, grid, params);
    for (const NearFieldMethod method : all_methods) {
        const bool convolves = method == NearFieldMethod::hybrid || method == NearFieldMethod::fft;
        if (convolves && grid.step == 0.6180339887498949) continue;  // no ratio: they refuse
        NearFieldParams p = params;
        p.method = method;
        const Difference d = compare(near_field(a, grid, p, {}), exact);
        EXPECT_LT(d.largest, 2e-6 * std::min(1.0, d.peak)) << what << ", " << near_field_method_name(method);
    }
}

class AllFresnelNumbers : public ::testing::TestWithParam<double> {};

TEST_P(AllFresnelNumbers, AgreeWithTheSumOverTexels) {
    for (const Aperture& a : {disc(64, 28.7), blades(64, 64), grey_blades(64, 64)}) {
        const NearFieldParams params = at_fresnel_number(a, GetParam());
        expect_exact(a, centred_plane(128, 64), params, "two pixels per texel");
        expect_exact(a, centred_plane(64, 64), params, "one pixel per texel");
    }
}

INSTANTIATE_TEST_SUITE_P(NearField, AllFresnelNumbers,
                         ::testing::Values(1e-15, 1e-6, 0.01, 0.1, 1, 10, 50, 100, 1000));

TEST(NearField, AnyPlane) {
    const Aperture square = blades(48, 48), wide = blades(53, 31), tall = blades(16, 45);
    for (const Aperture& a : {square, wide, tall}) {
        for (const double number : {0.3, 20.0}) {
            const NearFieldParams params = at_fresnel_number(a, number);
            expect_exact(a, {37, 50, -11.25, 3.5, 0.5}, params, "a window off the centre");
            expect_exact(a, {41, 23, 60.125, -90.75, 0.25}, params, "a window in the dark");
            expect_exact(a, {33, 19, -40, -33, 3}, params, "coarse pixels");
            expect_exact(a, {33, 19, -20, -13, 2.0 / 3}, params, "three pixels to two texels");
            expect_exact(a, {17, 29, -17.3, -13.1, 1.3}, params, "ten pixels to thirteen texels");
            expect_exact(a, {1, 1, 0.21, 0.4, 7}, params, "one pixel");
            expect_exact(a, {23, 18, -7.7, -6.1, 0.6180339887498949}, params, "no ratio");
        }
    }
}

/// Segmented mirrors, spiders, thin gaps, at the size of pictures: every 61st pixel of every 61st row.
TEST(NearField, RealPupils) {
    const std::filesystem::path folder = shared_folder("data/apertures");
    SKIP_WITHOUT(folder);
    for (const char* name : {"jwst", "keck", "hst"}) {
        std::ifstream file(folder / (std::string(name) + "_1024.png"), std::ios::binary);
        ASSERT_TRUE(file) << name;
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        const Image<Rgba8> picture = decode_png(bytes, name);
        Aperture a;
        a.pitch_m = 1e-5;
        a.mask = Image<float>(picture.width, picture.height);
        for (std::size_t i = 0; i < a.mask.pixels.size(); ++i)
            a.mask.pixels[i] = static_cast<float>(picture.pixels[i].r) / 255.0f;
        ASSERT_GT(open_area(a.mask.view()), 1000) << name;
        const PlaneGrid grid = centred_plane(1024, 1024);
        const PlaneGrid some{16, 15, grid.first_x + 30, grid.first_y + 3, 61};
        for (const double number : {3.0, 50.0, 400.0}) {
            NearFieldParams params = at_fresnel_number(a, number);
            const Plane exact = exact_field(a, some, params);
            for (const NearFieldMethod method :
                 {NearFieldMethod::edges, NearFieldMethod::hybrid, NearFieldMethod::fft}) {
                params.method = method;
                const Field field = near_field(a, grid, params, {});
                Field picked{Image<float>(16, 15), Image<float>(16, 15)};
                for (int y = 0; y < 15; ++y) {
                    for (int x = 0; x < 16; ++x) {
                        picked.re(x, y) = field.re(30 + 61 * x, 3 + 61 * y);
                        picked.im(x, y) = field.im(30 + 61 * x, 3 + 61 * y);
                    }
                }
                EXPECT_LT(compare(picked, exact).largest, 2e-6) << name << " at " << number;
            }
        }
    }
}

}  // namespace
}  // namespace obscura
