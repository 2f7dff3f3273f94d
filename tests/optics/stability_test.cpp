// Where far fields grow expensive or wrong, with numbers: the tables of optics/limits.md are what this
// program and near_field_stability_test print.

#include <gtest/gtest.h>

#include <cstdio>

#include "optics/far_field_progress.h"
#include "optics/field/quads.h"
#include "optics/psf.h"
#include "tests/optics/cases.h"
#include "tests/optics/far_field_reference.h"

namespace obscura {
namespace {

using namespace diffraction_cases;
using far_field_reference::Complex;
using far_field_reference::far_field_at;
using far_field_reference::worst_error;

Image<float> power_of(const Aperture& a, const FrequencyGrid& grid, const FarFieldParams& params = {}) {
    return far_field_power(a, grid, params, Exec{});
}

/// By the planner; error as a share of the open area at some of the grid's points.
double error_of(const Aperture& a, const FrequencyGrid& grid, FarFieldReport* report, int samples = 12) {
    const Field field = far_field(a, grid, {}, Exec{}, report);
    return worst_error(field, a.mask.view(), grid, open_area(a.mask.view()), samples);
}

TEST(DiffractionStability, NaturalImagesNeedAQuadPerTexel) {
    constexpr int size = 512;
    constexpr double texels = size * size;
    const Image<float> picture = photograph(size);
    Image<float> noise(size, size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x)
            noise(x, y) = hash_unit(x, y, 1) < 0.5f ? 1.0f : 0.0f;
    }
    struct Case {
        const char* name;
        Aperture aperture;
        double least_share, most_share;  // of quads per texel
        FarFieldMethod method;
    };
    const Case cases[] = {
        {"heptagon", binary_shape(ApertureKind::iris, size), 0.001, 0.01, FarFieldMethod::runs},
        {"photograph, two levels", of_mask(threshold(picture, 0.5f)), 0.01, 0.2, FarFieldMethod::runs},
        {"noise, two levels", of_mask(noise), 0.3, 0.6, FarFieldMethod::raster_fft},
        {"photograph, grey", of_mask(picture), 0.5, 1.4, FarFieldMethod::raster_fft}};
    for (const Case& c : cases) {
        const auto quads = static_cast<double>(quads_of(c.aperture.mask.view()).size());
        FarFieldReport report;
        const double error = error_of(c.aperture, half_grid(size, size, 1.0 / size), &report);
        std::printf("| %-22s | %7.0f | %5.3f | %.1e | %s |\n", c.name, quads, quads / texels, error,
                    report.reason.c_str());
        EXPECT_GT(quads / texels, c.least_share) << c.name;
        EXPECT_LT(quads / texels, c.most_share) << c.name;
        EXPECT_EQ(report.method, c.method) << c.name << ": " << report.reason;
        EXPECT_EQ(report.reason.find(far_field_method_name(c.method)), 0u) << report.reason;
        EXPECT_LT(error, 1e-6) << c.name;
    }
}

TEST(DiffractionStability, OddSizesBordersAndSpecksAreExact) {
    std::vector<far_field_reference::NamedMask> masks = far_field_reference::odd_masks();
    masks.push_back({"509 x 251, both prime",
                     far_field_reference::mask_where(
                         509, 251, [](double x, double y) { return x * x / 6 + y * y < 100 * 100; })});
    Image<float> cut = photograph(128);
    cut = threshold(cut, 0.45f);
    masks.push_back({"open to all four borders", cut});
    for (const auto& [name, mask] : masks) {
        double worst = 0;
        for (const FrequencyGrid& grid : far_field_reference::all_grids(std::max(mask.width, mask.height)))
            worst = std::max(worst, error_of(of_mask(mask), grid, nullptr));
        std::printf("| %-30s | %.1e |\n", name.c_str(), worst);
        EXPECT_LT(worst, 1e-6) << name;
    }
    // The size that a transform likes is that of the grid, not that of the mask.
    const Aperture prime = of_mask(masks[masks.size() - 2].mask);
    const FarFieldReport own = plan_far_field(prime, centred_grid(509, 251, 1.0 / 509), {}),
                         round = plan_far_field(prime, centred_grid(512, 256, 1.0 / 512), {});
    std::printf("| steps of 1/509 | %s |\n| steps of 1/512 | %s |\n", own.reason.c_str(),
                round.reason.c_str());
    EXPECT_GT(own.cost_ms, 1.2 * round.cost_ms);
}

/// A hole of one texel beside what is open: what is left of its own pattern, of unit amplitude, in float.
double pinhole_error(int size, bool by_difference) {
    Image<float> full = binary_shape(ApertureKind::circle, size).mask, holed = full;
    holed(size / 3, size / 2) = 0;
    const FrequencyGrid grid = centred_grid(24, 24, 0.7 / size);
    Image<float> dust(size, size);
    dust(size / 3, size / 2) = 1;
    const Field a = far_field(of_mask(by_difference ? dust : full), grid, {}, Exec{}),
                b = far_field(of_mask(by_difference ? Image<float>(size, size) : holed), grid, {}, Exec{});
    double worst = 0;
    std::vector<double> u, v;
    for (int i = 0; i < 24; ++i) {
        u.push_back(grid.first_u + i * grid.step_u);
        v.push_back(grid.first_v + i * grid.step_v);
    }
    const std::vector<Complex> exact = far_field_at(dust.view(), u, v);
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const Complex ours(static_cast<double>(a.re.pixels[i]) - static_cast<double>(b.re.pixels[i]),
                           static_cast<double>(a.im.pixels[i]) - static_cast<double>(b.im.pixels[i]));
        worst = std::max(worst, std::abs(ours - exact[i]));
    }
    return worst;
}

TEST(DiffractionStability, AHoleOfOneTexelDrownsInAWideOpening) {
    for (const int size : {64, 256, 1024}) {
        const double whole = pinhole_error(size, false), alone = pinhole_error(size, true);
        std::printf("| %4d | %.1e | %.1e | %.1e |\n", size, 1.0 / size / size, whole, alone);
        EXPECT_LT(alone, 1e-5);
        EXPECT_LT(whole, 1e-6 * size * size) << "the promise is a share of the open area";
        EXPECT_GT(whole, alone);
    }
}

TEST(DiffractionStability, FarOffAndZoomedWindowsKeepTheirAbsoluteError) {
    const Aperture a = binary_shape(ApertureKind::iris, 256);
    const double area = open_area(a.mask.view());
    struct Case {
        const char* name;
        FrequencyGrid grid;
        double most_relative;  // to the window's own peak
    };
    const Case cases[] = {{"natural", centred_grid(256, 256, 1.0 / 256), 1e-6},
                          {"zoom 1e3 at 20 fringes", centred_grid(64, 64, 1e-3 / 256, 0.0781, 0.031), 1},
                          {"zoom 1e6 at 20 fringes", centred_grid(64, 64, 1e-6 / 256, 0.0781, 0.031), 1},
                          {"zoom 1e9 at 20 fringes", centred_grid(64, 64, 1e-9 / 256, 0.0781, 0.031), 1},
                          {"10.3 cycles per texel", centred_grid(64, 64, 1.0 / 256, 10.3, 7.4), 10},
                          {"1000.3 cycles per texel", centred_grid(64, 64, 1.0 / 256, 1000.3, 700.4), 10}};
    for (const Case& c : cases) {
        const double error = error_of(a, c.grid, nullptr);
        const Image<float> power = power_of(a, c.grid);
        const double peak =
            std::sqrt(static_cast<double>(*std::max_element(power.pixels.begin(), power.pixels.end()))) /
            area;
        std::printf("| %-24s | %.1e | %.1e | %.1e |\n", c.name, error, peak, error / peak);
        EXPECT_LT(error, 1e-6) << c.name;
        EXPECT_LT(error / peak, c.most_relative) << c.name;
    }
}

TEST(DiffractionStability, CoarseQuadsCostPicturesLittleAtFirst) {
    constexpr int size = 1024, side = 256;
    for (const auto& [name, kind] : {std::pair{"box", ApertureKind::box},
                                     {"circle", ApertureKind::circle},
                                     {"heptagon", ApertureKind::iris},
                                     {"whirl", ApertureKind::whirl}}) {
        const Aperture fine = binary_shape(kind, size);
        const double area = open_area(fine.mask.view());
        const Image<Rgb8> truth =
            log_view(power_of(fine, centred_grid(side, side, 1.0 / size)).view(), area * area);
        double ssim_before = 1;
        for (int levels = 0; levels <= 3; ++levels) {
            const Aperture coarse = levels == 0 ? fine : reduce(fine, levels, true);
            const double scale = 1 << levels;
            // Frequencies in cycles per coarse texel; power in coarse texels^4.
            const Image<float> power = power_of(coarse, centred_grid(side, side, scale / size));
            const Likeness like =
                likeness(log_view(power.view(), area * area / (scale * scale * scale * scale)), truth);
            std::printf("| %-8s | %d | %4zu | %.3f | %.1f |\n", name, levels,
                        quads_of(coarse.mask.view()).size(), like.ssim, like.psnr_db);
            EXPECT_LE(like.ssim, ssim_before + 0.01) << name;
            if (levels == 1) {
                EXPECT_GT(like.ssim, 0.9) << name;
            }
            if (levels == 3 && kind != ApertureKind::box) {
                EXPECT_LT(like.ssim, 0.97) << name << ": steps of eight texels show";
            }
            ssim_before = like.ssim;
        }
    }
}

TEST(DiffractionStability, CullingMissesNothingAndKeepsTooMuch) {
    constexpr int size = 512;
    const Aperture a = binary_shape(ApertureKind::iris, size);
    const FrequencyGrid grid = centred_grid(size, size, 1.0 / size);
    const double peak = open_area(a.mask.view()) * open_area(a.mask.view());
    const Image<float> power = power_of(a, grid);
    for (const double threshold_share : {1e-4, 1e-6, 1e-8}) {
        FarFieldParams params;
        params.cull = threshold_share;
        FarFieldReport report;
        const Image<float> culled = far_field_power(a, grid, params, Exec{}, &report);
        int bright = 0, missed = 0;
        for (int y = 0; y < size; y += 8) {
            for (int x = 0; x < size; x += 8) {
                float most = 0, left = 0;
                for (int k = 0; k < 64; ++k) {
                    most = std::max(most, power(x + k % 8, y + k / 8));
                    left = std::max(left, culled(x + k % 8, y + k / 8));
                }
                const bool is_bright = static_cast<double>(most) > threshold_share * peak;
                bright += is_bright;
                missed += is_bright && left == 0.0f;
            }
        }
        std::printf("| %.0e | %5d | %5lld | %d | of %lld\n", threshold_share, bright,
                    static_cast<long long>(report.active_blocks), missed,
                    static_cast<long long>(report.blocks));
        EXPECT_EQ(missed, 0);
        // Of a mirrored aperture a quadrant is computed.
        const double kept = static_cast<double>(report.active_blocks) / static_cast<double>(report.blocks),
                     of_all = bright / 4096.0;
        EXPECT_GT(kept, 1.5 * of_all);
        EXPECT_LT(kept, threshold_share > 1e-5 ? 0.2 : 1.01);
    }
}

/// Root mean square difference of amplitudes between a mask and the exact polygon, as a share of the
/// polygon's, over the ring of frequencies [from, to).
struct Staircase {
    double binary = 0, coverage = 0, sharpened = 0;
};
Staircase staircase(double from, double to) {
    ApertureShape shape;
    shape.rotation_deg = 7;
    constexpr int size = 128, side = 160;
    const Aperture grey = make_aperture(shape, size, 1.0);
    const Aperture binary = of_mask(threshold(grey.mask, 0.5f));
    FrequencyGrid grid = half_grid(side, side, 2.02 * to / side);
    FarFieldParams polygon, texels;
    polygon.method = FarFieldMethod::polygon;
    texels.method = FarFieldMethod::runs;
    const Field exact = far_field(grey, grid, polygon, Exec{}),
                of_grey = far_field(grey, grid, texels, Exec{}),
                of_binary = far_field(binary, grid, texels, Exec{});
    Staircase sum;
    double all = 0;
    const auto at = [](const Field& f, int x, int y) {
        return Complex(static_cast<double>(f.re(x, y)), static_cast<double>(f.im(x, y)));
    };
    for (int y = 0; y < grid.height; ++y) {
        for (int x = 0; x < grid.width; ++x) {
            const double u = grid.first_u + x * grid.step_u, v = grid.first_v + y * grid.step_v;
            if (std::hypot(u, v) < from || std::hypot(u, v) >= to) continue;
            const Complex truth = at(exact, x, y);
            // Coverage averages over a texel, and the texel is one again: two sincs per axis.
            const double dimmed = std::pow(far_field_reference::sinc(u) * far_field_reference::sinc(v), 2);
            sum.binary += std::norm(at(of_binary, x, y) - truth);
            sum.coverage += std::norm(at(of_grey, x, y) - truth);
            sum.sharpened += std::norm(at(of_grey, x, y) / std::max(dimmed, 0.05) - truth);
            all += std::norm(truth);
        }
    }
    return {std::sqrt(sum.binary / all), std::sqrt(sum.coverage / all), std::sqrt(sum.sharpened / all)};
}

TEST(DiffractionStability, MasksEndAtAQuarterCyclePerTexel) {
    const double edges[] = {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8};
    for (std::size_t i = 0; i + 1 < std::size(edges); ++i) {
        const Staircase s = staircase(edges[i], edges[i + 1]);
        std::printf("| %.2f to %.2f | %.3f | %.3f | %.4f |\n", edges[i], edges[i + 1], s.binary, s.coverage,
                    s.sharpened);
        if (edges[i + 1] <= 0.5) {
            EXPECT_LT(s.sharpened, s.coverage);
            EXPECT_LT(s.coverage, s.binary);
        }
        if (edges[i + 1] <= 0.2) {
            EXPECT_LT(s.sharpened, 0.05);
        }
        if (edges[i] >= 0.5) {
            EXPECT_GT(std::min({s.binary, s.coverage, s.sharpened}), 0.9)
                << "beyond half a cycle a mask shows its texels";
        }
    }
}

TEST(DiffractionStability, FewWavelengthsShowAsSeparatePatterns) {
    const Aperture a = binary_shape(ApertureKind::iris, 256);
    for (const double fringes : {16.0, 64.0}) {
        // A window whose middle lies that many fringes from the centre.
        const FrequencyGrid grid = centred_grid(48, 48, 0.5 / 256, fringes / 256, 0.3 * fringes / 256);
        PsfParams params;
        params.wavelengths = 400;
        const Image<Vec3f> truth = far_field_colour(a, grid, 550, params, Exec{});
        double before = 1e9;
        for (const int count : {3, 8, 15, 60, 0}) {
            params.wavelengths = count;
            const double error = mean_relative(far_field_colour(a, grid, 550, params, Exec{}), truth);
            std::printf("| %3.0f | %3d | %.4f |\n", fringes, count, error);
            if (count == 3) {
                EXPECT_GT(error, 0.2);
            }
            if (count > 0) {
                EXPECT_LT(error, before);
            } else {
                EXPECT_LT(error, 0.01) << "the default tolerance";
            }
            before = error;
        }
    }
}

/// Largest error of a field after a thousand specks of dust have come and gone, as a share of the open area.
double drift(double tolerance, int& refreshes, double& bound) {
    Image<float> mask = binary_shape(ApertureKind::iris, 128).mask;
    FarFieldProgress progress;
    progress.grid = centred_grid(48, 48, 1.0 / 128);
    progress.tolerance = tolerance;
    refreshes = 0;
    for (int k = 0; k < 1000; ++k) {
        float& texel = mask(50 + k * 7 % 28, 45 + k * 5 % 36);
        texel = 1 - texel;
        const ProgressReport report = update_far_field(progress, mask.view(), Exec{Exec{}.isa, 1});
        refreshes += report.refreshed;
        bound = report.error_bound;
    }
    return worst_error(progress.field, mask.view(), progress.grid, open_area(mask.view()), 16);
}

TEST(DiffractionStability, AThousandUpdatesStayWithinTheirBound) {
    for (const double tolerance : {3e-6, 1.0}) {
        int refreshes = 0;
        double bound = 0;
        const double error = drift(tolerance, refreshes, bound);
        std::printf("| %.0e | %d | %.1e | %.1e |\n", tolerance, refreshes, bound, error);
        EXPECT_LT(error, bound);
        EXPECT_LE(bound, tolerance);
        if (tolerance > 0.5) {
            EXPECT_EQ(refreshes, 1) << "the first alone";
        } else {
            EXPECT_GT(refreshes, 1);
        }
    }
}

TEST(DiffractionStability, KernelsLeaveLightOutside) {
    ApertureShape shape;
    shape.kind = ApertureKind::circle;
    const Aperture circle = make_aperture(shape, 128, 1.0);
    Aperture bare = circle;
    bare.outline = {};
    for (const double f_number : {2.0, 8.0, 22.0}) {
        double before = 0;
        for (const int radius : {2, 8, 32}) {
            PsfParams params;
            params.f_number = f_number;
            params.radius_px = radius;
            const Psf known = far_field_psf(circle, params, Exec{}),
                      unknown = far_field_psf(bare, params, Exec{});
            std::printf("| %2.0f | %2d | %.4f | %.2f | %.2f |\n", f_number, radius, known.captured,
                        known.plan.highest_cycles_per_texel, unknown.plan.highest_cycles_per_texel);
            EXPECT_GT(known.captured, before);
            EXPECT_LT(known.captured, 1.001);
            before = known.captured;
            if (f_number == 2.0 && radius == 32) {
                EXPECT_GT(unknown.plan.highest_cycles_per_texel, 0.5)
                    << "such a kernel says nothing of its rim";
            }
        }
    }
}

}  // namespace
}  // namespace obscura
