// Coloured far fields: closed forms, convergence in wavelengths, and the errors of the paper's modes.

#include <gtest/gtest.h>

#include <cmath>

#include "core/num.h"
#include "optics/aperture_shapes.h"
#include "optics/psf.h"

namespace obscura {
namespace {

Aperture aperture_of(ApertureKind kind, int size, int blades = 7) {
    ApertureShape shape;
    shape.kind = kind;
    shape.blades = blades;
    return make_aperture(shape, size, 0.01);
}

Aperture box_of(int size, int side) {
    Aperture aperture;
    aperture.mask = Image<float>(size, size);
    aperture.pitch_m = 1e-5;
    for (int y = (size - side) / 2; y < (size + side) / 2; ++y) {
        for (int x = (size - side) / 2; x < (size + side) / 2; ++x)
            aperture.mask(x, y) = 1;
    }
    return aperture;
}

/// Mean over the pixels within `radius` of the centre of |error| / reference, over X, Y and Z (the measure of
/// the notes on spectral integration).
double xyz_error(const Image<Vec3f>& image, const Image<Vec3f>& reference, double radius) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (std::hypot(x - image.width / 2, y - image.height / 2) >= radius) continue;
            const Vec3d a = xyz_from_srgb(to_double(image(x, y))),
                        b = xyz_from_srgb(to_double(reference(x, y)));
            sum += (std::fabs(a.x - b.x) / b.x + std::fabs(a.y - b.y) / b.y + std::fabs(a.z - b.z) / b.z) / 3;
            ++count;
        }
    }
    return sum / count;
}

PsfParams params_of(SpectralMethod method, int wavelengths = 0) {
    PsfParams params;
    params.method = method;
    params.wavelengths = wavelengths;
    params.light.source = LightSource::equal;
    return params;
}

TEST(FarFieldColour, OfABoxIsAProductOfSincs) {
    const Aperture box = box_of(128, 48);
    const FrequencyGrid grid = centred_grid(61, 45, 1.0 / 256);
    const PsfParams params = params_of(SpectralMethod::exact, 90);
    const Image<Vec3f> colour = far_field_colour(box, grid, 560, params, {});
    const auto samples = spectral_samples(params.light, 90);
    double peak = 0;
    for (const SpectralSample& s : samples)
        peak += s.xyz.y * std::pow(560 / s.wavelength_nm, 2);
    const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(M_PI * x) / (M_PI * x); };
    for (int y = 0; y < grid.height; ++y) {
        for (int x = 0; x < grid.width; ++x) {
            Vec3d expected;
            for (const SpectralSample& s : samples) {
                const double scale = 560 / s.wavelength_nm;
                const double amplitude =
                    scale * sinc(48 * scale * (x - 30) / 256.0) * sinc(48 * scale * (y - 22) / 256.0);
                expected = expected + s.rgb * (amplitude * amplitude / peak);
            }
            EXPECT_NEAR(static_cast<double>(colour(x, y).x), expected.x, 3e-6);
            EXPECT_NEAR(static_cast<double>(colour(x, y).y), expected.y, 3e-6);
            EXPECT_NEAR(static_cast<double>(colour(x, y).z), expected.z, 3e-6);
        }
    }
    EXPECT_NEAR(srgb_luminance(to_double(colour(30, 22))), 1, 1e-5);
    // Short waves are the most concentrated: the middle is bluer than the light.
    EXPECT_GT(colour(30, 22).z, 1.2f * colour(30, 22).x);
}

TEST(FarFieldColour, RingsGrowWithTheWavelength) {
    // First zero of the Airy pattern at 1.2197 cycles per diameter, times the wavelength over the reference.
    const Aperture circle = aperture_of(ApertureKind::circle, 256);
    const double diameter = 0.9 * 256, step = 0.02 / diameter;
    const auto first_zero = [&](double nm) {
        PsfParams params = params_of(SpectralMethod::exact);
        params.light = {LightSource::monochromatic, 0, nm};
        const auto row = far_field_colour(circle, {100, 1, 0, 0, step, step}, 550, params, {});
        int x = 1;
        while (std::fabs(row(x, 0).y) > std::fabs(row(x + 1, 0).y))
            ++x;
        return x * 0.02;
    };
    EXPECT_NEAR(first_zero(550), 1.2197, 0.021);
    EXPECT_NEAR(first_zero(450), 1.2197 * 450 / 550, 0.021);
    EXPECT_NEAR(first_zero(650), 1.2197 * 650 / 550, 0.021);
}

TEST(FarFieldColour, IsLinearInTheLight) {
    // A light of two lines is the sum of its lines, each weighted by its luminance times its dispersion.
    const Aperture hept = aperture_of(ApertureKind::iris, 128);
    const FrequencyGrid grid = centred_grid(33, 33, 1.0 / 256);
    PsfParams params = params_of(SpectralMethod::exact);
    params.light = {LightSource::sodium};
    const auto both = far_field_colour(hept, grid, 550, params, {});
    Image<Vec3f> lines[2];
    const double nm[2] = {588.995, 589.592};
    double weight[2];
    for (int i = 0; i < 2; ++i) {
        params.light = {LightSource::monochromatic, 0, nm[i]};
        lines[i] = far_field_colour(hept, grid, 550, params, {});
        weight[i] = (2 - i) * observer_xyz(nm[i]).y / (nm[i] * nm[i]);
    }
    for (std::size_t p = 0; p < both.pixels.size(); ++p) {
        const double sum = (weight[0] * static_cast<double>(lines[0].pixels[p].x) +
                            weight[1] * static_cast<double>(lines[1].pixels[p].x)) /
                           (weight[0] + weight[1]);
        EXPECT_NEAR(static_cast<double>(both.pixels[p].x), sum, 2e-6);
    }
}

TEST(FarFieldColour, ChoosesEnoughWavelengths) {
    for (const ApertureKind kind : {ApertureKind::iris, ApertureKind::circle, ApertureKind::whirl}) {
        const Aperture aperture = aperture_of(kind, 128);
        const FrequencyGrid grid = centred_grid(144, 144, 1.0 / 128);
        const auto reference =
            far_field_colour(aperture, grid, 550, params_of(SpectralMethod::exact, 240), {});
        const auto chosen = far_field_colour(aperture, grid, 550, params_of(SpectralMethod::exact), {});
        EXPECT_LT(xyz_error(chosen, reference, 1000), 0.01) << static_cast<int>(kind);
        const auto few = far_field_colour(aperture, grid, 550, params_of(SpectralMethod::exact, 25), {});
        EXPECT_GT(xyz_error(few, reference, 1000), 0.04) << static_cast<int>(kind);
    }
}

TEST(FarFieldColour, LookupsNeedAFineGridAndCubics) {
    const Aperture hept = aperture_of(ApertureKind::iris, 256);
    const FrequencyGrid grid = centred_grid(96, 96, 1.0 / 256);
    const auto exact = far_field_colour(hept, grid, 550, params_of(SpectralMethod::exact, 60), {});
    const auto lookup = far_field_colour(hept, grid, 550, params_of(SpectralMethod::lookup), {});
    const double error = xyz_error(lookup, exact, 1000);
    RecordProperty("lookup_error", std::to_string(error));
    EXPECT_LT(error, 0.01);
    // Batches sample geometrically, so they are compared with what many samples give.
    const auto converged = far_field_colour(hept, grid, 550, params_of(SpectralMethod::exact, 240), {});
    const auto batch = far_field_colour(hept, grid, 550, params_of(SpectralMethod::batch), {});
    const double batch_error = xyz_error(batch, converged, 1000);
    RecordProperty("batch_error", std::to_string(batch_error));
    EXPECT_LT(batch_error, 0.03);
    EXPECT_LT(xyz_error(batch, converged, 24), 0.02);
}

TEST(FarFieldColour, BatchesOfLinesAreLookups) {
    const Aperture hept = aperture_of(ApertureKind::iris, 128);
    const FrequencyGrid grid = centred_grid(32, 32, 1.0 / 256);
    PsfParams params = params_of(SpectralMethod::batch);
    params.light = {LightSource::sodium};
    const auto batch = far_field_colour(hept, grid, 550, params, {});
    params.method = SpectralMethod::exact;
    const auto exact = far_field_colour(hept, grid, 550, params, {});
    double worst = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i)
        worst = std::max(worst, std::fabs(static_cast<double>(batch.pixels[i].x - exact.pixels[i].x)));
    EXPECT_LT(worst, 0.015);
    EXPECT_GT(worst, 0);
}

TEST(FarFieldColour, ThreadsAndInstructionSetsDoNotShow) {
    const Aperture hept = aperture_of(ApertureKind::iris, 128);
    const FrequencyGrid grid = centred_grid(64, 48, 1.0 / 256);
    for (const SpectralMethod method :
         {SpectralMethod::exact, SpectralMethod::lookup, SpectralMethod::batch}) {
        const auto once = far_field_colour(hept, grid, 550, params_of(method, 20), {Isa::ref, 1});
        for (const Isa isa : supported_isas())
            EXPECT_TRUE(far_field_colour(hept, grid, 550, params_of(method, 20), {isa, 2}) == once);
    }
}

TEST(FarFieldColour, RefusesWhatHasNoPattern) {
    Aperture closed = box_of(32, 16);
    const FrequencyGrid grid = centred_grid(8, 8, 1.0 / 64);
    EXPECT_THROW(far_field_colour(closed, grid, 0.55, params_of(SpectralMethod::exact), {}), InputError);
    EXPECT_THROW(far_field_colour(closed, grid, 550, params_of(SpectralMethod::exact, -1), {}), InputError);
    closed.mask = Image<float>(32, 32);
    EXPECT_THROW(far_field_colour(closed, grid, 550, params_of(SpectralMethod::exact), {}), InputError);
}

}  // namespace
}  // namespace obscura
