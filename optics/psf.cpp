// Point spread functions at the true size of a sensor's pixels.
//
// L. Scandolo: thesis, 2019, section 3.4.3 (equations 3.15 to 3.17) adds wavelengths at points of the
// pattern. Pixels are seldom points: at f/8 one of 18.75 um is four fringes of the aperture's diameter wide,
// and a point in it says nothing of its light. So pixels integrate here, exactly, by summed-area tables.

#include "optics/psf.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "optics/aperture_extent.h"
#include "optics/far_field_methods.h"
#include "optics/field/sinc.h"
#include "optics/outline_coverage.h"
#include "optics/pixel_integrals.h"
#include "optics/psf_memory.h"

namespace obscura {

namespace {

constexpr double reference_nm = 550;
constexpr std::size_t most_exact_corners = 16;  ///< outlines of more are cheaper as masks
constexpr int finest_mask = 4096;
constexpr double faithful_cycles_per_texel = 0.25;
constexpr double shortest_of_weight_nm = 440;  ///< below, little is seen

void check_params(const PsfParams& p) {
    const auto require = [](bool good, const char* message) {
        if (!good) throw InputError("", message);
    };
    require(p.focal_length_m > 0, "focal length must be positive");
    require(p.f_number > 0 && p.f_number < 1e4, "f-number must be positive");
    require(p.pixel_m > 0 && p.pixel_m <= 1, "pixels must be wider than 0 and at most 1 m");
    require(p.radius_px >= 0 && p.radius_px <= 4096, "kernel radius must be 0 to 4096 pixels");
    check_sampling(p.wavelengths, p.tolerance);
}

/// Width of a pixel in cycles per aperture diameter.
double cycles_per_pixel(const PsfParams& params, double wavelength_nm) {
    return params.pixel_m / (wavelength_nm * 1e-9 * params.f_number);
}

/// What the frequencies wanted ask of an aperture.
struct PupilForm {
    bool closed_form = false;  ///< its outline's few straight edges serve as they are
    bool coverage = false;     ///< else: what is transformed is the exact coverage of a known outline
    int finer = 1;             ///< so many texels for each of the aperture's, along both axes
};

/// The aperture in that form.
struct Pupil {
    Aperture aperture;
    FarFieldParams far_field;
    bool coverage = false;
    double power = 0;  ///< Parseval's total
};

/// Few corners, none outside the mask, where the opening is cut off.
bool has_closed_form(const Aperture& aperture) {
    std::size_t corners = 0;
    for (const auto& loop : aperture.outline.loops) {
        corners += loop.size();
        for (const Vec2d& p : loop) {
            if (p.x < 0 || p.y < 0 || p.x > aperture.mask.width || p.y > aperture.mask.height) return false;
        }
    }
    return aperture.outline.disjoint && corners > 0 && corners <= most_exact_corners;
}

/// Outlines of few straight edges: their closed form, exact at every frequency. Other outlines: a mask fine
/// enough. Only a mask: that.
PupilForm form_for(const Aperture& aperture, double cycles_per_texel) {
    PupilForm form;
    form.closed_form = has_closed_form(aperture);
    form.coverage = !form.closed_form && !aperture.outline.loops.empty();
    if (!form.coverage) return form;
    const int side = std::max(aperture.mask.width, aperture.mask.height);
    while (cycles_per_texel / form.finer > faithful_cycles_per_texel && side * form.finer * 2 <= finest_mask)
        form.finer *= 2;
    return form;
}

Pupil pupil_of(const Aperture& aperture, const PupilForm& form) {
    Pupil pupil{aperture, {}, form.coverage, 0};
    if (form.closed_form) {
        pupil.far_field.method = FarFieldMethod::polygon;
        pupil.power = open_area(aperture.mask.view());
        return pupil;
    }
    if (form.finer > 1) {
        pupil.aperture.pitch_m /= form.finer;
        for (auto& loop : pupil.aperture.outline.loops) {
            for (Vec2d& p : loop)
                p = p * static_cast<double>(form.finer);
        }
        pupil.aperture.mask = coverage_of(pupil.aperture.outline, aperture.mask.width * form.finer,
                                          aperture.mask.height * form.finer);
    }
    const auto mask = pupil.aperture.mask.view();
    pupil.power = form.coverage ? open_area(mask) : transmitted_power(mask);
    return pupil;
}

/// What coverage has dimmed at a frequency, one axis's factor: the mean of a shape over each texel, shown as
/// a square again, has the shape's amplitude times sinc(u)^2, up to half a cycle per texel.
double coverage_gain(double frequency) {
    const double sinc = sinc_in_double(std::min(std::fabs(frequency), 0.5));
    return 1 / (sinc * sinc * sinc * sinc);
}

Image<float> pupil_power(const Pupil& pupil, const FrequencyGrid& grid, const Exec& exec) {
    Image<float> power = far_field_power(pupil.aperture, grid, pupil.far_field, exec);
    if (!pupil.coverage) return power;
    std::vector<float> gain;
    gain.reserve(static_cast<std::size_t>(grid.width));
    for (int x = 0; x < grid.width; ++x)
        gain.push_back(static_cast<float>(coverage_gain(grid.first_u + x * grid.step_u)));
    parallel_blocks(static_cast<std::size_t>(grid.height), 64, exec, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            const float row_gain = static_cast<float>(coverage_gain(grid.first_v + y * grid.step_v));
            float* row = power.row(y);
            for (int x = 0; x < grid.width; ++x)
                row[x] *= row_gain * gain[static_cast<std::size_t>(x)];
        }
    });
    return power;
}

/// Past half a cycle per texel follow copies of the pattern, rainbows that no aperture has: the kernel of a
/// mask fades out before, for all wavelengths at the same pixels, so that its streaks keep their colour.
struct Fading {
    double begin_px = 0, end_px = 0;
    /// Share that is kept of pixels this far along an axis; all of the middle one.
    double kept(int px) const {
        if (px == 0) return 1;
        const double t = std::clamp((std::abs(px) + 0.5 - begin_px) / (end_px - begin_px), 0.0, 1.0);
        return 1 - t * t * (3 - 2 * t);
    }
    /// Radius beyond which nothing is kept.
    int radius(int most) const { return end_px < most ? static_cast<int>(std::ceil(end_px)) : most; }
};

Fading fading_of(const PupilForm& form, double pixel) {
    const double end = form.closed_form ? 1e9 : 0.5 / pixel;
    return {0.6 * end, end};
}

/// A kernel of a larger radius, faded, dark around the one given.
Image<Vec3d> faded(const Image<Vec3d>& inner, const Fading& fading, int radius_px) {
    const int side = 2 * radius_px + 1, inner_radius = inner.width / 2;
    Image<Vec3d> kernel(side, side);
    for (int y = -inner_radius; y <= inner_radius; ++y) {
        for (int x = -inner_radius; x <= inner_radius; ++x) {
            kernel(radius_px + x, radius_px + y) =
                inner(inner_radius + x, inner_radius + y) * (fading.kept(x) * fading.kept(y));
        }
    }
    return kernel;
}

/// Wavelengths that the kernel needs. A pixel's light passes fringes as the pattern scales past it, but none
/// finer than the pixel itself: it averages over them.
int wavelength_count(const Aperture& aperture, const PsfParams& params, double texel_cycles) {
    if (params.wavelengths > 0) return params.wavelengths;
    const double edge = params.radius_px * texel_cycles;
    const double fringes = std::min(fringes_to(aperture.mask.view(), edge, edge), 2.0 * params.radius_px);
    return spectral_rate(params.light, fringes, params.tolerance).count;
}

/// Side of the cells that sample the power of a mask this wide, in cycles per texel: half a fringe of the
/// aperture's extent, or a share of a pixel where that is less; for masks a power of two, which fast Fourier
/// transforms serve.
double cell_for(const PupilForm& form, const OpenExtent& extent, int side, double pixel,
                const PsfParams& params) {
    const double fringe = 1.0 / std::max(extent.width, extent.height);
    // Constant power over cells is wrong by 0.3 (cell / fringe)^2 of the peak at worst, where a pixel's
    // border cuts them. Many wavelengths cut them everywhere, which evens out; lines do not.
    constexpr double for_lines = 2;
    const double lines = has_lines(params.light) ? for_lines : 1;
    const double finer = std::max(1.0, std::sqrt(0.01 / params.tolerance));
    const double share = std::max(pixel / 8, std::min(pixel / 5, fringe / 8)) / finer;
    // Pixels of many fringes need little more than one cell for each: the whole of |F|^2 is exact from one
    // on. But the fringes of straight edges, all alike, beat with cells of nearly their own width as slowly
    // as pixels are wide; with cells of three quarters, every three fringes.
    const double most = std::min(share, std::clamp(pixel / (16 * finer), fringe / 2, 0.75 * fringe)) / lines;
    if (form.closed_form) return most;
    double cell = 1;
    while (cell > most || cell * side > 1)
        cell /= 2;
    return cell;
}

/// Sums of X, Y and Z over a kernel.
Vec3d sum_of(const Image<Vec3d>& kernel) {
    Vec3d sum;
    for (const Vec3d& pixel : kernel.pixels)
        sum = sum + pixel;
    return sum;
}

Vec3d ratio(Vec3d a, Vec3d b) {
    return {b.x > 0 ? a.x / b.x : 0, b.y > 0 ? a.y / b.y : 0, b.z > 0 ? a.z / b.z : 0};
}

/// XYZ to displayable linear sRGB that sums to the light's colour, both as the gamut holds them.
Image<Vec3f> balanced_kernel(Image<Vec3d> xyz, const LightSpectrum& light) {
    const Vec3d whole = ratio(light_xyz(light), sum_of(xyz));
    for (Vec3d& pixel : xyz.pixels)
        pixel = into_gamut(srgb_from_xyz(pixel * whole));
    const Vec3d mapped = ratio(into_gamut(srgb_from_xyz(light_xyz(light))), sum_of(xyz));
    Image<Vec3f> kernel(xyz.width, xyz.height);
    for (std::size_t i = 0; i < xyz.pixels.size(); ++i)
        kernel.pixels[i] = to_float(xyz.pixels[i] * mapped);
    return kernel;
}

/// What wavelengths there are, and how large pixels are for them before the pupil's texels are known.
struct Wavelengths {
    std::vector<SpectralSample> samples;
    double reference_cycles = 0;  ///< per pixel, in cycles of the aperture's width
    double highest = 0;           ///< at the kernel's edge, cycles per texel of the aperture
};

Wavelengths wavelengths_of(const Aperture& aperture, const PsfParams& params) {
    Wavelengths w;
    const double diameter = aperture.mask.width;
    w.reference_cycles = cycles_per_pixel(params, reference_nm);
    w.samples =
        spectral_samples(params.light, wavelength_count(aperture, params, w.reference_cycles / diameter));
    w.highest =
        (params.radius_px + 0.5) * cycles_per_pixel(params, w.samples.front().wavelength_nm) / diameter;
    return w;
}

/// How the power of a pupil of this many texels is sampled and gathered.
struct Sampling {
    double cell = 0;  ///< cycles per texel of the pupil
    std::vector<PixelLight> lights;
    Fading fading;
    int lit_radius = 0;
    PixelIntegralWork work;
};

Sampling sampling_of(const Wavelengths& wavelengths, const PupilForm& form, const OpenExtent& extent,
                     int width, int height, double power, const PsfParams& params) {
    Sampling s;
    s.cell = cell_for(form, extent, std::max(width, height), wavelengths.reference_cycles / width, params);
    for (const SpectralSample& sample : wavelengths.samples)
        s.lights.push_back(
            {cycles_per_pixel(params, sample.wavelength_nm) / width, sample.xyz * (1 / power)});
    const double blue_nm = std::max(wavelengths.samples.front().wavelength_nm, shortest_of_weight_nm);
    s.fading = fading_of(form, cycles_per_pixel(params, blue_nm) / width);
    s.lit_radius = s.fading.radius(params.radius_px);
    s.work = pixel_integral_work(s.cell, s.lit_radius, s.lights);
    return s;
}

/// All that is decided before anything is computed.
struct Job {
    Pupil pupil;
    Sampling sampling;
    PsfPlan plan;
};

double far_field_ms(const Pupil& pupil, const PixelIntegralWork& work) {
    const double bands =
        static_cast<double>(work.frequencies) / (static_cast<double>(work.band.width) * work.band.height);
    if (pupil.far_field.method == FarFieldMethod::polygon)
        return 1e-6 * bands * far_field_polygon_cost_ns(pupil.aperture.outline, work.band);
    return bands * plan_far_field(pupil.aperture, work.band, pupil.far_field).cost_ms;
}

void check_open(const Aperture& aperture) {
    if (open_extent(aperture.mask.view()).width == 0) throw InputError("aperture", "lets no light through");
}

Job job_of(const Aperture& aperture, const PsfParams& params) {
    check_params(params);
    check_open(aperture);
    const Wavelengths wavelengths = wavelengths_of(aperture, params);
    const PupilForm form = form_for(aperture, wavelengths.highest);
    Job job;
    job.pupil = pupil_of(aperture, form);
    const Image<float>& mask = job.pupil.aperture.mask;
    job.sampling = sampling_of(wavelengths, form, open_extent(mask.view()), mask.width, mask.height,
                               job.pupil.power, params);
    const Sampling& s = job.sampling;
    job.plan.wavelengths = static_cast<int>(wavelengths.samples.size());
    job.plan.cycles_per_px = wavelengths.reference_cycles;
    job.plan.highest_cycles_per_texel = wavelengths.highest * aperture.mask.width / mask.width;
    job.plan.method =
        plan_far_field(job.pupil.aperture, centred_grid(64, 64, s.cell), job.pupil.far_field).method;
    job.plan.frequencies = s.work.frequencies;
    job.plan.cost_ms =
        far_field_ms(job.pupil, s.work) + pixel_integral_cost_ms(s.work, s.lit_radius, s.lights.size());
    return job;
}

}  // namespace

PsfPlan plan_far_field_psf(const Aperture& aperture, const PsfParams& params) {
    return job_of(aperture, params).plan;
}

Psf far_field_psf(const Aperture& aperture, const PsfParams& params, const Exec& exec,
                  const std::function<void(double)>& progress) {
    const Job job = job_of(aperture, params);
    std::int64_t done = 0;
    const auto power = [&](const FrequencyGrid& grid) {
        if (progress)
            progress(static_cast<double>(done) / static_cast<double>(job.sampling.work.frequencies));
        done += std::int64_t{grid.width} * grid.height;
        return pupil_power(job.pupil, grid, exec);
    };
    const Sampling& s = job.sampling;
    Image<Vec3d> xyz =
        faded(integrate_over_pixels(power, s.cell, s.lit_radius, s.lights, exec), s.fading, params.radius_px);
    Psf psf;
    psf.plan = job.plan;
    psf.captured = sum_of(xyz).y;
    psf.kernel = balanced_kernel(std::move(xyz), params.light);
    return psf;
}

std::int64_t far_field_psf_bytes(const Aperture& aperture, const PsfParams& params) {
    check_params(params);
    check_open(aperture);
    const Wavelengths wavelengths = wavelengths_of(aperture, params);
    const PupilForm form = form_for(aperture, wavelengths.highest);
    const int width = aperture.mask.width * form.finer, height = aperture.mask.height * form.finer;
    // A finer mask is open no further out than the texels that it divides.
    OpenExtent extent = open_extent(aperture.mask.view());
    extent.width *= form.finer;
    extent.height *= form.finer;
    const Sampling s = sampling_of(wavelengths, form, extent, width, height, 1, params);

    // The aperture and its copy, or a finer mask in the copy's place.
    const auto texels = [](std::int64_t w, std::int64_t h) { return w * h * std::int64_t{sizeof(float)}; };
    const std::int64_t masks = texels(aperture.mask.width, aperture.mask.height) + texels(width, height);
    // Transforms of rasters keep every row's, complex; others some columns at a time.
    const bool rasters = form.finer == 1 && !form.closed_form &&
                         plan_far_field(aperture, s.work.band, {}).method == FarFieldMethod::raster_fft;
    const std::int64_t rows = rasters ? 2 * texels(width, height) : 0;
    // One after the other: the bands' power gathered into half a kernel; all of it; the kernel faded;
    // balanced; and, by the caller, scaled.
    const std::int64_t lit = 2 * s.lit_radius + 1, side = 2 * params.radius_px + 1;
    const std::int64_t half = lit * (s.lit_radius + 1) * std::int64_t{sizeof(Vec3d)},
                       whole = lit * lit * std::int64_t{sizeof(Vec3d)},
                       faded_kernel = side * side * std::int64_t{sizeof(Vec3d)},
                       kernel = side * side * std::int64_t{sizeof(Vec3f)};
    const std::int64_t gathering = pixel_integral_bytes(s.work, s.lit_radius, s.lights.size()) +
                                   texels(s.work.band.width, s.work.band.height) + rows;
    return masks + std::max({gathering, half + whole, whole + faded_kernel, faded_kernel + 2 * kernel});
}

}  // namespace obscura
