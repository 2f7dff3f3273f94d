// Near fields: one set of bits for every instruction set and number of threads, sampled kernels as the
// negative control, coarse masks, culling, the planner, colour, input that means nothing.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"
#include "optics/near_field.h"
#include "optics/near_field_colour.h"
#include "optics/thesis/scaled_intensity.h"
#include "tests/optics/near_field_oracle.h"

namespace obscura {
namespace {

using namespace near_field_oracle;

constexpr NearFieldMethod all_methods[] = {NearFieldMethod::direct, NearFieldMethod::two_pass,
                                           NearFieldMethod::edges, NearFieldMethod::hybrid,
                                           NearFieldMethod::fft};

TEST(NearFieldBits, SameOnEveryInstructionSetAndThread) {
    const Aperture cases[] = {blades(70, 53), disc(64, 27), grey_blades(40, 40)};
    for (const Aperture& a : cases) {
        const PlaneGrid planes[] = {centred_plane(145, 72.5), {50, 83, -31.25, 4.5, 0.25}};
        for (const PlaneGrid& grid : planes) {
            for (const NearFieldMethod method : all_methods) {
                NearFieldParams params = at_fresnel_number(a, 9);
                params.method = method;
                const Field expected = near_field(a, grid, params, {Isa::ref, 1});
                const Image<float> power = near_field_intensity(a, grid, params, {Isa::ref, 1});
                for (const Isa isa : supported_isas()) {
                    for (const int threads : {1, 3}) {
                        const Field f = near_field(a, grid, params, {isa, threads});
                        EXPECT_TRUE(f.re == expected.re && f.im == expected.im)
                            << near_field_method_name(method) << " " << isa_name(isa);
                        EXPECT_TRUE(near_field_intensity(a, grid, params, {isa, threads}) == power);
                    }
                }
                for (std::size_t i = 0; i < power.pixels.size(); ++i) {
                    const float re = expected.re.pixels[i], im = expected.im.pixels[i];
                    EXPECT_NEAR(power.pixels[i], re * re + im * im, 1e-6f);
                }
            }
        }
    }
}

/// Mirrored masks give mirrored patterns bit for bit, also where only part of the plane is computed.
TEST(NearFieldBits, MirrorImages) {
    const Aperture a = disc(48, 20.3);
    for (const NearFieldMethod method : {NearFieldMethod::edges, NearFieldMethod::hybrid}) {
        NearFieldParams params = at_fresnel_number(a, 5);
        params.method = method;
        for (const int size : {96, 144, 36, 9}) {
            const Image<float> power = near_field_intensity(a, centred_plane(size, 48), params, {});
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x)
                    ASSERT_EQ(power(x, y), power(size - 1 - x, y));
            }
        }
    }
}

/// Figure 3.12: a chirp that is sampled at the texels' centres and convolved fails as z falls, at the same
/// padding at which the integrated one is exact.
TEST(NearField, SampledKernelsFailWhereIntegratedOnesDoNot) {
    const int size = 96;
    const Aperture a = disc(size, 42);
    for (const double number : {1.0, 10.0, 50.0}) {
        const NearFieldParams params = at_fresnel_number(a, number);
        const double turns = a.pitch_m * a.pitch_m / (2 * params.wavelength_m * params.distance_m);
        const PlaneGrid grid = centred_plane(size, size);
        const Plane exact = exact_field(a, grid, params);
        // The sampled chirp at the distance of d texels, both axes' share of 1 / (i lambda z).
        const auto sample = [&](int d) {
            return std::polar(2 * std::sqrt(turns), 2 * 3.14159265358979323846 * turns * d * d) /
                   Complex(1, 1);
        };
        double sampled = 0;
        for (int k = 0; k < size; k += 7) {
            for (int i = 0; i < size; ++i) {
                Complex sum;
                for (int y = 0; y < size; ++y) {
                    Complex row;
                    for (int x = 0; x < size; ++x)
                        row += static_cast<double>(a.mask(x, y)) * sample(i - x);
                    sum += row * sample(k - y);
                }
                sampled = std::max(sampled, std::abs(sum - exact(i, k)));
            }
        }
        NearFieldParams p = params;
        p.method = NearFieldMethod::fft;
        EXPECT_LT(compare(near_field(a, grid, p, {}), exact).largest, 2e-6) << number;
        EXPECT_GT(sampled, number < 5 ? 1e-4 : number < 20 ? 1e-2 : 0.5) << number;
    }
}

TEST(NearField, CoarseMasksAreThemselvesExact) {
    const Aperture a = blades(90, 61);  // sizes that 4 does not divide: the centre moves
    NearFieldParams params = at_fresnel_number(a, 6);
    const PlaneGrid grid{64, 48, -40, -27.5, 1};
    const Field coarse = [&] {
        NearFieldParams p = params;
        p.coarse_levels = 2;
        return near_field(a, grid, p, {});
    }();
    // The same mask by hand, in texels of the fine one: no centre to get wrong.
    const Aperture reduced = reduce(a, 2, true);
    Aperture fine = aperture_where(90, 61, [&](double x, double y) {
        return reduced.mask(static_cast<int>(x + 45) / 4, static_cast<int>(y + 30.5) / 4);
    });
    EXPECT_LT(compare(coarse, exact_field(fine, grid, params)).largest, 2e-6);
    // And near the fine mask's field.
    const Plane exact = exact_field(a, grid, params);
    double squares = 0, power = 0;
    for (int y = 0; y < grid.height; ++y) {
        for (int x = 0; x < grid.width; ++x) {
            const Complex u(static_cast<double>(coarse.re(x, y)), static_cast<double>(coarse.im(x, y)));
            squares += std::norm(u - exact(x, y));
            power += std::norm(exact(x, y));
        }
    }
    EXPECT_LT(squares / power, 0.1);
    EXPECT_GT(squares / power, 1e-4);
}

TEST(NearField, CulledBlocksAreDarkAndOthersUntouched) {
    const Aperture a = blades(64, 64);
    NearFieldParams params = at_fresnel_number(a, 8);
    params.method = NearFieldMethod::edges;
    const PlaneGrid grid{200, 171, -100, -85, 1};
    const Image<float> all = near_field_intensity(a, grid, params, {});
    params.cull = 4e-3;
    NearFieldReport report;
    const Image<float> culled = near_field_intensity(a, grid, params, {}, &report);
    EXPECT_EQ(report.blocks, 25 * 22);
    // What the header promises, from exact values at the centres of blocks.
    const Plane centres = exact_field(a, {25, 22, -96.5, -81.5, 8}, params);
    const auto is_bright = [&](int bx, int by) {
        for (int y = std::max(by - 1, 0); y <= std::min(by + 1, 21); ++y) {
            for (int x = std::max(bx - 1, 0); x <= std::min(bx + 1, 24); ++x) {
                if (std::norm(centres(x, y)) >= params.cull) return true;
            }
        }
        return false;
    };
    int active = 0;
    for (int by = 0; by < 22; ++by) {
        for (int bx = 0; bx < 25; ++bx) {
            bool kept = true, dark = true;
            float brightest = 0;
            for (int y = 8 * by; y < std::min(8 * by + 8, 171); ++y) {
                for (int x = 8 * bx; x < 8 * bx + 8; ++x) {
                    kept = kept && culled(x, y) == all(x, y);
                    dark = dark && culled(x, y) == 0.0f;
                    brightest = std::max(brightest, all(x, y));
                }
            }
            EXPECT_TRUE(kept || dark);
            EXPECT_EQ(!dark, is_bright(bx, by)) << bx << " " << by;
            if (!dark) ++active;
            if (dark) {
                EXPECT_LT(brightest, 0.015f);
            }
        }
    }
    EXPECT_EQ(report.active_blocks, active);
    EXPECT_GT(active, 25);
    EXPECT_LT(active, 400);
}

TEST(NearFieldPlan, CullingMeansEdges) {
    const Aperture a = blades(256, 256);
    const PlaneGrid grid = centred_plane(512, 512);
    NearFieldParams params = at_fresnel_number(a, 10);
    ASSERT_EQ(plan_near_field(a, grid, params).method, NearFieldMethod::hybrid);
    params.cull = 0.01;
    NearFieldReport report;
    near_field_intensity(a, grid, params, {}, &report);
    EXPECT_EQ(report.method, NearFieldMethod::edges);
    EXPECT_NE(report.reason.find("only edges can cull"), std::string::npos) << report.reason;
    EXPECT_EQ(report.blocks, 64 * 64);
    EXPECT_LT(report.active_blocks, report.blocks);
    params.method = NearFieldMethod::hybrid;
    EXPECT_THROW(plan_near_field(a, grid, params), InputError);
    params.method = NearFieldMethod::automatic;
    params.cull = -1;
    EXPECT_THROW(plan_near_field(a, grid, params), InputError);
}

TEST(NearFieldPlan, FollowsTheMask) {
    const auto chosen = [](const Aperture& a, const PlaneGrid& grid) {
        const NearFieldReport plan = plan_near_field(a, grid, at_fresnel_number(a, 10));
        EXPECT_NE(plan.reason.find(near_field_method_name(plan.method)), std::string::npos);
        EXPECT_GT(plan.cost_ms, 0);
        return plan.method;
    };
    const int n = 256;
    const Aperture box =
        aperture_where(n, n, [](double x, double y) { return std::fabs(x) < 70 && std::fabs(y) < 90; });
    const Aperture grating = aperture_where(
        n, n, [](double x, double y) { return std::fabs(y) < 100 && static_cast<int>(x + n) % 8 < 4; });
    std::mt19937 random(3);
    const Aperture noise = aperture_where(n, n, [&](double, double) { return random() % 2 == 0; });
    const PlaneGrid plane = centred_plane(2 * n, n);
    EXPECT_EQ(chosen(box, plane), NearFieldMethod::edges);
    EXPECT_EQ(chosen(grating, plane), NearFieldMethod::edges);
    EXPECT_EQ(chosen(blades(n, n), plane), NearFieldMethod::hybrid);
    EXPECT_EQ(chosen(noise, plane), NearFieldMethod::fft);
    EXPECT_EQ(chosen(noise, centred_plane(n, 0.77316 * n)), NearFieldMethod::edges);  // no ratio
    EXPECT_EQ(plan_near_field(grating, plane, at_fresnel_number(grating, 10)).edges, 1);
    EXPECT_EQ(plan_near_field(box, plane, at_fresnel_number(box, 10)).edges, 1);
}

TEST(NearField, RefusesWhatMeansNothing) {
    const Aperture a = disc(16, 6);
    const PlaneGrid grid = centred_plane(16, 16);
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    for (const double z : {0.0, -1.0, nan, inf, 1e300, 1e-300}) {
        NearFieldParams params;
        params.distance_m = z;
        EXPECT_THROW(near_field(a, grid, params, {}), InputError) << z;
        EXPECT_THROW(plan_near_field(a, grid, params), InputError) << z;
    }
    NearFieldParams params = at_fresnel_number(a, 3);
    for (const double wavelength : {0.0, -5e-7, nan, inf}) {
        NearFieldParams p = params;
        p.wavelength_m = wavelength;
        EXPECT_THROW(near_field(a, grid, p, {}), InputError);
    }
    for (const PlaneGrid& plane :
         {PlaneGrid{4, 4, 0, 0, 0}, PlaneGrid{4, 4, nan, 0, 1}, PlaneGrid{4, 4, 0, 0, -1},
          PlaneGrid{4, 4, 0, inf, 1}, PlaneGrid{4, 4, 0, 0, inf}, PlaneGrid{0, 4, 0, 0, 1},
          PlaneGrid{4, -1, 0, 0, 1}}) {
        EXPECT_THROW(near_field(a, plane, params, {}), InputError);
        EXPECT_THROW(near_field_intensity(a, plane, params, {}), InputError);
        EXPECT_THROW(plan_near_field(a, plane, params), InputError);
    }
    for (const NearFieldMethod method : {NearFieldMethod::hybrid, NearFieldMethod::fft}) {
        NearFieldParams p = params;
        p.method = method;
        EXPECT_THROW(near_field(a, centred_plane(16, 13.777), p, {}), InputError);
    }
    params.coarse_levels = -1;
    EXPECT_THROW(near_field(a, grid, params, {}), InputError);
}

TEST(NearField, EmptyAndFullMasks) {
    for (const NearFieldMethod method : all_methods) {
        const Aperture none = aperture_where(40, 24, [](double, double) { return false; });
        NearFieldParams params = at_fresnel_number(none, 5);
        params.method = method;
        for (const float v : near_field_intensity(none, centred_plane(50, 25), params, {}).pixels)
            EXPECT_EQ(v, 0.0f);
        const Aperture one = aperture_where(1, 1, [](double, double) { return true; });
        params = at_fresnel_number(one, 0.1);
        params.method = method;
        const PlaneGrid grid{5, 3, -2, -1, 1};
        EXPECT_LT(compare(near_field(one, grid, params, {}), exact_field(one, grid, params)).largest, 1e-6);
    }
}

TEST(NearFieldColours, ExactSumsWavelengthsAndScaledComesNear) {
    const Aperture a = disc(64, 26);
    NearFieldParams params = at_fresnel_number(a, 12);
    const PlaneGrid grid = centred_plane(96, 72);
    const LightSpectrum light;
    const Image<Vec3f> exact = near_field_colour(a, grid, params, light, 12, NearFieldColour::exact, {});
    Vec3d expected{0, 0, 0};
    for (const SpectralSample& s : spectral_samples(light, 12)) {
        params.wavelength_m = s.wavelength_nm * 1e-9;
        expected =
            expected + s.rgb * std::norm(exact_field(
                                   a, {1, 1, grid.first_x + 40 * grid.step, grid.first_y + 30 * grid.step, 1},
                                   params)(0, 0));
    }
    EXPECT_NEAR(exact(40, 30).x, expected.x, 1e-4);
    EXPECT_NEAR(exact(40, 30).y, expected.y, 1e-4);
    EXPECT_NEAR(exact(40, 30).z, expected.z, 1e-4);
    const Image<Vec3f> scaled = near_field_colour(a, grid, params, light, 12, NearFieldColour::scaled, {});
    double squares = 0, power = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
        const double e = exact.pixels[i].y, s = scaled.pixels[i].y;
        squares += (e - s) * (e - s);
        power += e * e;
    }
    EXPECT_LT(std::sqrt(squares / power), 0.2);   // plausible
    EXPECT_GT(std::sqrt(squares / power), 0.01);  // not exact
    // rho = 1 changes nothing; rho < 1 (red) shrinks the picture.
    const Image<float> ramp = [] {
        Image<float> image(33, 33);
        for (int y = 0; y < 33; ++y) {
            for (int x = 0; x < 33; ++x)
                image(x, y) = static_cast<float>(x - 16);
        }
        return image;
    }();
    const PlaneGrid plane{33, 33, -16, -16, 1};
    EXPECT_TRUE(scaled_intensity(ramp.view(), plane, 1) == ramp);
    EXPECT_NEAR(scaled_intensity(ramp.view(), plane, 0.8)(24, 5), 8 * 1.01f, 1e-5f);
    EXPECT_NEAR(scaled_intensity(ramp.view(), plane, 1.2)(24, 5), 8 * 0.99f, 1e-5f);
}

}  // namespace
}  // namespace obscura
