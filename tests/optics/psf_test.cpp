// Point spread functions of lenses: energy, size, streaks, colour, determinism.

#include "optics/psf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optics/aperture_extent.h"
#include "optics/aperture_shapes.h"

namespace obscura {
namespace {

Aperture aperture_of(ApertureKind kind, int size, int blades = 7, double diameter = 1) {
    ApertureShape shape;
    shape.kind = kind;
    shape.blades = blades;
    shape.diameter = diameter;
    return make_aperture(shape, size, 0.01);
}

PsfParams lens(double f_number, double pixel_um, int radius) {
    PsfParams params;
    params.f_number = f_number;
    params.pixel_m = pixel_um * 1e-6;
    params.radius_px = radius;
    return params;
}

Vec3d sum_of(const Image<Vec3f>& kernel) {
    Vec3d sum;
    for (const Vec3f& pixel : kernel.pixels)
        sum = sum + to_double(pixel);
    return sum;
}

double luminance(const Psf& psf, int x, int y) {
    return srgb_luminance(to_double(psf.kernel(x, y)));
}

TEST(Psf, AiryDiscsHoldTheirEncircledEnergy) {
    // f/16, 550 nm: the first dark ring has radius 1.22 x 8.8 um = 10.7 um; pixels of 0.55 um.
    PsfParams params = lens(16, 0.55, 100);
    params.light = {LightSource::monochromatic, 0, 550};
    const Psf psf = far_field_psf(aperture_of(ApertureKind::circle, 512), params, {});
    EXPECT_NEAR(psf.plan.cycles_per_px, 0.0625, 1e-12);
    const auto encircled = [](double cycles) {
        return 1 - std::pow(std::cyl_bessel_j(0.0, M_PI * cycles), 2) -
               std::pow(std::cyl_bessel_j(1.0, M_PI * cycles), 2);
    };
    for (const double cycles : {0.5, 1.2197, 2.2331, 3.2383, 5.0}) {
        double share = 0;
        for (int y = -100; y <= 100; ++y) {
            for (int x = -100; x <= 100; ++x) {
                // Pixels on the circle count by how much of them lies inside.
                int inside = 0;
                for (int k = 0; k < 100; ++k) {
                    const double dx = x - 0.45 + 0.1 * (k % 10), dy = y - 0.45 + 0.1 * (k / 10);
                    inside += std::hypot(dx, dy) * psf.plan.cycles_per_px < cycles ? 1 : 0;
                }
                share += luminance(psf, 100 + x, 100 + y) * inside / 100;
            }
        }
        EXPECT_NEAR(share * psf.captured, encircled(cycles), 0.003) << cycles;
    }
    // The square of 6.28 cycles half side holds more than the circle in it, less than that around it.
    EXPECT_GT(psf.captured, encircled(6.28));
    EXPECT_LT(psf.captured, encircled(6.28 * std::sqrt(2.0)));
}

TEST(Psf, SumsToTheLight) {
    const Aperture hept = aperture_of(ApertureKind::iris, 256);
    for (const LightSource source :
         {LightSource::d65, LightSource::blackbody, LightSource::sodium, LightSource::rgb_led}) {
        for (const double f_number : {4.0, 22.0}) {
            PsfParams params = lens(f_number, 6, 24);
            params.light = {source, 3000};
            const Psf psf = far_field_psf(hept, params, {});
            const Vec3d sum = sum_of(psf.kernel),
                        expected = into_gamut(srgb_from_xyz(light_xyz(params.light)));
            EXPECT_NEAR(sum.x, expected.x, 1e-5);
            EXPECT_NEAR(sum.y, expected.y, 1e-5);
            EXPECT_NEAR(sum.z, expected.z, 1e-5);
            EXPECT_NEAR(srgb_luminance(sum), 1, 1e-5);
            for (const Vec3f& pixel : psf.kernel.pixels)
                ASSERT_GE(std::min({pixel.x, pixel.y, pixel.z}), 0.0f);
        }
    }
}

TEST(Psf, LargerKernelsCatchMore) {
    const Aperture hept = aperture_of(ApertureKind::iris, 256);
    double before = 0;
    for (const int radius : {0, 1, 4, 16, 64}) {
        const Psf psf = far_field_psf(hept, lens(11, 4, radius), {});
        EXPECT_GT(psf.captured, before) << radius;
        EXPECT_LE(psf.captured, 1.002) << radius;
        before = psf.captured;
    }
    EXPECT_GT(before, 0.99);
}

TEST(Psf, GrowsWithTheFNumber) {
    // Twice the f-number with twice the pixel is the same picture; half the pixels' size is twice the
    // picture.
    const Aperture hept = aperture_of(ApertureKind::iris, 256);
    const Psf one = far_field_psf(hept, lens(8, 6, 20), {}), same = far_field_psf(hept, lens(16, 12, 20), {});
    for (std::size_t i = 0; i < one.kernel.pixels.size(); ++i)
        EXPECT_NEAR(one.kernel.pixels[i].y, same.kernel.pixels[i].y, 1e-9f);
    // f/24 at 3 x 3 pixels each is f/8: kernels add up.
    const Psf fine = far_field_psf(hept, lens(24, 6, 61), {});
    const double scale = fine.captured / one.captured;
    for (int y = 0; y < 41; ++y) {
        for (int x = 0; x < 41; ++x) {
            double sum = 0;
            for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < 3; ++i)
                    sum += luminance(fine, 3 * x + i, 3 * y + j);
            }
            EXPECT_NEAR(sum * scale, luminance(one, x, y), 0.008 * luminance(one, 20, 20));
        }
    }
}

/// Maxima along a circle of `radius` pixels that stand out from their surroundings.
int streaks(const Psf& psf, double radius) {
    const int centre = psf.kernel.width / 2, steps = 720;
    std::vector<double> ring;
    for (int i = 0; i < steps; ++i) {
        const double angle = 2 * M_PI * i / steps;
        double sum = 0;
        for (int r = -3; r <= 3; ++r) {
            sum += luminance(psf, centre + static_cast<int>(std::lround((radius + r) * std::cos(angle))),
                             centre + static_cast<int>(std::lround((radius + r) * std::sin(angle))));
        }
        ring.push_back(sum);
    }
    double mean = 0;
    for (const double r : ring)
        mean += r / steps;
    // Runs of the circle brighter than its mean, gaps of a degree closed.
    int runs = 0;
    for (int i = 0; i < steps; ++i) {
        bool dark_before = true;
        for (int k = 1; k <= 6; ++k)
            dark_before = dark_before && ring[static_cast<std::size_t>((i + steps - k) % steps)] < mean;
        runs += dark_before && ring[static_cast<std::size_t>(i)] >= mean ? 1 : 0;
    }
    return runs;
}

TEST(Psf, EvenBladesGiveAsManyStreaksOddTwice) {
    for (const int blades : {5, 6, 7, 8, 9}) {
        const Psf psf = far_field_psf(aperture_of(ApertureKind::iris, 512, blades), lens(11, 6, 64), {});
        EXPECT_EQ(streaks(psf, 55), blades % 2 == 0 ? blades : 2 * blades) << blades;
    }
}

TEST(Psf, ColourRunsFromBlueInsideToRedOutside) {
    // The first bright ring of the Airy pattern, between 1.22 and 2.23 cycles of each channel's own light.
    PsfParams params = lens(64, 4, 60);
    params.light.source = LightSource::rgb_led;
    const Psf psf = far_field_psf(aperture_of(ApertureKind::circle, 256), params, {});
    double peak[3] = {0, 0, 0};
    int at[3] = {0, 0, 0};
    for (int r = 8; r < 30; ++r) {
        const Vec3f pixel = psf.kernel(60 + r, 60);
        const double channel[3] = {static_cast<double>(pixel.x), static_cast<double>(pixel.y),
                                   static_cast<double>(pixel.z)};
        const Vec3f inner = psf.kernel(60 + r - 1, 60), outer = psf.kernel(60 + r + 1, 60);
        const float before[3] = {inner.x, inner.y, inner.z}, after[3] = {outer.x, outer.y, outer.z};
        for (int c = 0; c < 3; ++c) {
            const bool maximum =
                channel[c] > static_cast<double>(before[c]) && channel[c] >= static_cast<double>(after[c]);
            if (maximum && channel[c] > peak[c] && at[c] == 0) {
                peak[c] = channel[c];
                at[c] = r;
            }
        }
    }
    // Ring maxima at 1.635 cycles: radius 1.635 lambda N / pixel.
    EXPECT_NEAR(at[0], 1.635 * 0.630 * 64 / 4, 1.5);
    EXPECT_NEAR(at[1], 1.635 * 0.525 * 64 / 4, 1.5);
    EXPECT_NEAR(at[2], 1.635 * 0.465 * 64 / 4, 1.5);
    EXPECT_LT(at[2], at[1]);
    EXPECT_LT(at[1], at[0]);
}

TEST(Psf, ChoosesEnoughWavelengths) {
    for (const double pixel_um : {2.0, 12.0}) {
        PsfParams params = lens(11, pixel_um, 48);
        const Aperture hept = aperture_of(ApertureKind::iris, 256);
        const Psf chosen = far_field_psf(hept, params, {});
        params.wavelengths = 4 * chosen.plan.wavelengths;
        const Psf many = far_field_psf(hept, params, {});
        params.wavelengths = 12;
        const Psf few = far_field_psf(hept, params, {});
        double error = 0, few_error = 0;
        for (std::size_t i = 0; i < many.kernel.pixels.size(); ++i) {
            const Vec3d a = xyz_from_srgb(to_double(many.kernel.pixels[i]));
            const auto off = [&](const Psf& psf) {
                const Vec3d b = xyz_from_srgb(to_double(psf.kernel.pixels[i]));
                return (std::fabs(a.x - b.x) / a.x + std::fabs(a.y - b.y) / a.y +
                        std::fabs(a.z - b.z) / a.z) /
                       3;
            };
            error += off(chosen) / static_cast<double>(many.kernel.pixels.size());
            few_error += off(few) / static_cast<double>(many.kernel.pixels.size());
        }
        EXPECT_LT(error, params.tolerance) << pixel_um;
        EXPECT_GT(few_error, params.tolerance) << pixel_um;
    }
}

TEST(Psf, OutlinesServeWhereMasksDoNot) {
    // A coarse hexagon: its outline in closed form, a mask made of its outline (disjoint taken back, so that
    // the closed form does not apply), and its texels alone.
    PsfParams params = lens(8, 18.75, 24);
    const Aperture hexagon = aperture_of(ApertureKind::iris, 128, 6);
    Aperture outlined = hexagon, bare = hexagon;
    outlined.outline.disjoint = false;
    bare.outline = {};
    const Psf exact = far_field_psf(hexagon, params, {}), mask = far_field_psf(outlined, params, {});
    const Psf texels = far_field_psf(bare, params, {});
    EXPECT_EQ(exact.plan.method, FarFieldMethod::polygon);
    EXPECT_NE(mask.plan.method, FarFieldMethod::polygon);
    EXPECT_LT(mask.plan.highest_cycles_per_texel, 0.26);
    EXPECT_GT(texels.plan.highest_cycles_per_texel, 1);
    // The tip of the streak along x, which the texels of an upright edge dim.
    double shown[2] = {0, 0};
    for (int x = 36; x < 49; ++x) {
        shown[0] += luminance(exact, x, 24);
        shown[1] += luminance(mask, x, 24);
    }
    EXPECT_NEAR(shown[1] / shown[0], 1, 0.02);
    // No copies of the pattern: dark past half a cycle per texel of 440 nm.
    const double limit_px = 0.5 * 128 * 440e-9 * params.f_number / params.pixel_m;
    ASSERT_LT(limit_px, 20);
    for (int x = 0; x < 49; ++x)
        EXPECT_EQ(luminance(texels, x, 24) > 0, std::abs(x - 24) + 0.5 < limit_px) << x;
    // Everywhere else too, relative to each pixel's own light.
    double error = 0;
    for (int y = 0; y < 49; ++y) {
        for (int x = 0; x < 49; ++x)
            error += std::fabs(luminance(mask, x, y) / luminance(exact, x, y) - 1) / (49 * 49);
    }
    EXPECT_LT(error, 0.08);
}

TEST(Psf, CellsAreFineEnough) {
    // From pixels that are a small part of the central spot to pixels of many fringes, against finer cells
    // and more wavelengths: relative to each pixel's own light in the mean, and to the brightest at worst.
    // Lines leave fringes as they are; a box has all of an axis's alike.
    const LightSpectrum daylight, sodium{LightSource::sodium}, green{LightSource::monochromatic, 0, 550};
    for (const ApertureKind kind : {ApertureKind::iris, ApertureKind::box}) {
        const Aperture aperture = aperture_of(kind, 256);
        for (const LightSpectrum& light : {daylight, sodium, green}) {
            for (const double f_number : {1.4, 5.6, 22.0, 45.0, 90.0}) {
                PsfParams params = lens(f_number, 12, 20);
                params.light = light;
                params.wavelengths = 150;
                const Psf psf = far_field_psf(aperture, params, {});
                params.tolerance = 2e-4;
                const Psf fine = far_field_psf(aperture, params, {});
                ASSERT_GT(fine.plan.frequencies, 3 * psf.plan.frequencies);
                double mean = 0, worst = 0;
                for (int y = 0; y < 41; ++y) {
                    for (int x = 0; x < 41; ++x) {
                        const double error = std::fabs(luminance(psf, x, y) - luminance(fine, x, y));
                        mean += error / luminance(fine, x, y) / (41 * 41);
                        worst = std::max(worst, error / luminance(fine, 20, 20));
                    }
                }
                EXPECT_LT(mean, 0.01) << aperture_kind_name(kind) << " " << light_source_name(light.source)
                                      << " f/" << f_number;
                EXPECT_LT(worst, 0.01) << aperture_kind_name(kind) << " " << light_source_name(light.source)
                                       << " f/" << f_number;
            }
        }
    }
}

TEST(Psf, LightPastALineFollowsFromTheBorder) {
    // The kernel's own light beyond columns and rows, less what one so large has lost all around.
    const auto measured = [](const Psf& psf, int from, int radius) {
        double past = 0, all = 0;
        for (int y = -radius; y <= radius; ++y) {
            for (int x = -radius; x <= radius; ++x) {
                const double light = luminance(psf, radius + x, radius + y);
                all += light;
                past += light * ((x >= from) + (x <= -from) + (y >= from) + (y <= -from)) / 4;
            }
        }
        return past / all;
    };
    struct Case {
        ApertureKind kind;
        int blades;
    };
    for (const Case& c : {Case{ApertureKind::circle, 0}, Case{ApertureKind::iris, 8},
                          Case{ApertureKind::iris, 7}, Case{ApertureKind::annulus, 0}}) {
        const Aperture aperture = aperture_of(c.kind, 256, c.blades);
        const int radius = 240;
        const Psf psf = far_field_psf(aperture, lens(16, 4.4, radius), {});
        const double cycles_per_texel = psf.plan.cycles_per_px / 256;
        for (const int from : {4, 8, 16}) {
            const double expected = light_past_line(aperture.mask.view(), (from - 0.5) * cycles_per_texel) -
                                    light_past_line(aperture.mask.view(), (radius + 0.5) * cycles_per_texel);
            const double ratio = measured(psf, from, radius) / expected;
            EXPECT_LT(ratio, 1.15) << aperture_kind_name(c.kind) << " " << c.blades << " " << from;
            // A telescope's thin vanes are known as borders only farther out.
            if (c.kind == ApertureKind::annulus && from < 16) continue;
            EXPECT_GT(ratio, 0.85) << aperture_kind_name(c.kind) << " " << c.blades << " " << from;
        }
    }
}

TEST(Psf, MasksOfVeryFewTexelsStillHaveAKernel) {
    Aperture bare = aperture_of(ApertureKind::circle, 16);
    bare.outline = {};
    const Psf psf = far_field_psf(bare, lens(1.4, 18.75, 8), {});
    const Vec3d sum = sum_of(psf.kernel);
    EXPECT_NEAR(srgb_luminance(sum), 1, 1e-5);
    EXPECT_GT(luminance(psf, 8, 8), 0.5);
}

TEST(Psf, ThreadsAndInstructionSetsDoNotShow) {
    const Aperture hept = aperture_of(ApertureKind::iris, 128);
    const PsfParams params = lens(8, 6, 20);
    const Psf once = far_field_psf(hept, params, {Isa::ref, 1});
    for (const Isa isa : supported_isas()) {
        const Psf psf = far_field_psf(hept, params, {isa, 2});
        EXPECT_TRUE(psf.kernel == once.kernel);
        EXPECT_EQ(psf.captured, once.captured);
    }
}

TEST(Psf, RefusesWhatNoLensHas) {
    const Aperture hept = aperture_of(ApertureKind::iris, 64);
    EXPECT_THROW(far_field_psf(hept, lens(0, 6, 8), {}), InputError);
    EXPECT_THROW(far_field_psf(hept, lens(8, -1, 8), {}), InputError);
    EXPECT_THROW(far_field_psf(hept, lens(8, 6, -1), {}), InputError);
    Aperture closed = hept;
    closed.mask = Image<float>(64, 64);
    EXPECT_THROW(far_field_psf(closed, lens(8, 6, 8), {}), InputError);
    EXPECT_THROW(far_field_psf(hept, lens(1, 1000, 4096), {}), LimitError);
    // One pixel holds everything.
    const Psf dot = far_field_psf(hept, lens(8, 6, 0), {});
    ASSERT_EQ(dot.kernel.pixels.size(), 1u);
    EXPECT_NEAR(dot.kernel.pixels[0].x, 1, 1e-6);
}

TEST(Psf, APlanSaysWhatIsDone) {
    const Aperture aperture = make_aperture({}, 128, 0.005);
    PsfParams params;
    params.radius_px = 12;
    const PsfPlan plan = plan_far_field_psf(aperture, params);
    const Psf psf = far_field_psf(aperture, params, {});
    EXPECT_EQ(plan.method, psf.plan.method);
    EXPECT_EQ(plan.frequencies, psf.plan.frequencies);
    EXPECT_EQ(plan.wavelengths, psf.plan.wavelengths);
    EXPECT_GT(plan.cost_ms, 0);

    // Twice the pixel in cycles, twice as far: four times the frequencies, and the time of them.
    params.f_number /= 8;
    params.wavelengths = plan.wavelengths;
    const PsfPlan once = plan_far_field_psf(aperture, params);
    params.radius_px *= 2;
    const PsfPlan twice = plan_far_field_psf(aperture, params);
    EXPECT_NEAR(static_cast<double>(twice.frequencies) / static_cast<double>(once.frequencies), 4, 0.3);
    EXPECT_NEAR(twice.cost_ms / once.cost_ms, 4, 0.5);
}

}  // namespace
}  // namespace obscura
