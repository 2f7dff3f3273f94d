// The coloured far field, wavelength by wavelength.
//
// L. Scandolo: thesis, 2019, section 3.4.3, equations 3.15 to 3.17. The paper looks one pattern up at 60
// scales
// (`lookup`), or four at a time (`batch`). The default, `exact`, computes each wavelength's pattern on its
// own grid, since it costs little more here and bilinear lookups are the larger error.

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "optics/aperture_extent.h"
#include "optics/psf.h"
#include "optics/spectral_lookup.h"

namespace obscura {

namespace {

constexpr int lookup_wavelengths = 60;
constexpr int batch_lookups = 15;

struct Colouring {
    const Aperture& aperture;
    FrequencyGrid grid;
    double reference_nm = 0;
    double peak = 0;  ///< F(0)
    LightSpectrum light;
};

/// Step of the power image: half of what samples of |F|^2 need to hold it.
double lookup_step(const OpenExtent& extent) {
    return 1.0 / (4.0 * std::max(extent.width, extent.height));
}

/// Scale of a wavelength's pattern on the grid of the reference (rho of 3.15).
double scale_of(const Colouring& c, const SpectralSample& sample) {
    return c.reference_nm / sample.wavelength_nm;
}

/// The weights of 3.17, dispersive factor included, with luminance 1 at frequency 0.
std::vector<Vec3d> weights_of(const Colouring& c, const std::vector<SpectralSample>& samples) {
    std::vector<Vec3d> weights;
    double luminance = 0;
    for (const SpectralSample& sample : samples) {
        const double scale = scale_of(c, sample);
        weights.push_back(sample.rgb * (scale * scale));
        luminance += sample.xyz.y * scale * scale;
    }
    for (Vec3d& weight : weights)
        weight = weight * (1 / (luminance * c.peak * c.peak));
    return weights;
}

/// Wavelengths whose fringes are resolved at the corner of the grid that lies farthest out.
int wavelength_count(const Colouring& c, double tolerance) {
    const FrequencyGrid& g = c.grid;
    double fringes = 0;
    for (const double u : {g.first_u, g.first_u + (g.width - 1) * g.step_u}) {
        for (const double v : {g.first_v, g.first_v + (g.height - 1) * g.step_v})
            fringes = std::max(fringes, fringes_to(c.aperture.mask.view(), u, v));
    }
    return spectral_rate(c.light, fringes * c.reference_nm / 550, tolerance).count;
}

std::vector<SpectralSample> exact_samples(const Colouring& c, const PsfParams& params) {
    return spectral_samples(
        params.light, params.wavelengths > 0 ? params.wavelengths : wavelength_count(c, params.tolerance));
}

/// Where a wavelength's pattern is sampled.
FrequencyGrid grid_of(const Colouring& c, const SpectralSample& sample) {
    FrequencyGrid grid = c.grid;
    for (double* value : {&grid.first_u, &grid.first_v, &grid.step_u, &grid.step_v})
        *value *= scale_of(c, sample);
    return grid;
}

void add_exact(const Colouring& c, const std::vector<SpectralSample>& samples, Image<Vec3f>& sum,
               const Exec& exec, const std::function<void(double)>& progress) {
    const std::vector<Vec3d> weights = weights_of(c, samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Image<float> power = far_field_power(c.aperture, grid_of(c, samples[i]), {}, exec);
        const Vec3f colour = to_float(weights[i]);
        parallel_blocks(sum.pixels.size(), 1 << 14, exec, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p)
                sum.pixels[p] = sum.pixels[p] + colour * power.pixels[p];
        });
        if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(samples.size()));
    }
}

/// A power image that serves all samples' scales, at least twice as fine as power needs.
PowerImage power_for(const Colouring& c, const std::vector<SpectralSample>& samples, const Exec& exec) {
    const OpenExtent extent = open_extent(c.aperture.mask.view());
    PowerImage image;
    image.grid =
        scaled_cover(c.grid, scale_of(c, samples.back()), scale_of(c, samples.front()), lookup_step(extent));
    image.power = far_field_power(c.aperture, image.grid, {}, exec);
    return image;
}

void add_lookups(const Colouring& c, const std::vector<SpectralSample>& samples, Image<Vec3f>& sum,
                 const Exec& exec) {
    const std::vector<Vec3d> weights = weights_of(c, samples);
    const PowerImage from = power_for(c, samples, exec);
    for (std::size_t i = 0; i < samples.size(); ++i)
        add_scaled_power(from, c.grid, scale_of(c, samples[i]), weights[i], Interpolation::cubic, sum, exec);
}

/// Sample 4 j + i has the scale of sample 4 j times that of ladder[i].
void add_batches(const Colouring& c, const std::vector<SpectralSample>& samples, Image<Vec3f>& sum,
                 const Exec& exec) {
    const std::vector<Vec3d> weights = weights_of(c, samples);
    const PowerImage from = power_for(c, samples, exec);
    double ladder[4];
    for (std::size_t i = 0; i < 4; ++i)
        ladder[i] = samples[0].wavelength_nm / samples[i].wavelength_nm;
    const PowerBatch batch = gather_batch(from, from.grid, ladder, Interpolation::cubic, exec);
    for (std::size_t j = 0; j < batch_lookups; ++j) {
        const Vec3d four[4] = {weights[4 * j], weights[4 * j + 1], weights[4 * j + 2], weights[4 * j + 3]};
        add_scaled_batch(batch, c.grid, scale_of(c, samples[4 * j]), four, Interpolation::cubic, sum, exec);
    }
}

Colouring colouring_of(const Aperture& aperture, const FrequencyGrid& grid, double reference_nm,
                       const PsfParams& params) {
    if (!(reference_nm >= 100 && reference_nm <= 10000))
        throw UsageError("reference wavelength must be 100 to 10000 nm");
    if (params.wavelengths < 0 || params.wavelengths > 100000)
        throw UsageError("wavelength count must be 0 to 100000");
    if (!(params.tolerance >= 1e-4 && params.tolerance <= 0.5))
        throw UsageError("tolerance must be 0.0001 to 0.5");
    const Colouring c{aperture, grid, reference_nm, open_area(aperture.mask.view()), params.light};
    if (!(c.peak > 0)) throw InputError("aperture", "lets no light through");
    return c;
}

}  // namespace

ColourPlan plan_far_field_colour(const Aperture& aperture, const FrequencyGrid& grid, double reference_nm,
                                 const PsfParams& params) {
    const Colouring c = colouring_of(aperture, grid, reference_nm, params);
    const std::vector<SpectralSample> samples = exact_samples(c, params);
    ColourPlan plan;
    plan.wavelengths = static_cast<int>(samples.size());
    plan.middle = plan_far_field(aperture, grid_of(c, samples[samples.size() / 2]), {});
    plan.cost_ms = plan.wavelengths * plan.middle.cost_ms;
    return plan;
}

Image<Vec3f> far_field_colour(const Aperture& aperture, const FrequencyGrid& grid, double reference_nm,
                              const PsfParams& params, const Exec& exec,
                              const std::function<void(double)>& progress) {
    const Colouring c = colouring_of(aperture, grid, reference_nm, params);
    Image<Vec3f> sum(grid.width, grid.height);
    if (params.method == SpectralMethod::batch) {
        const auto samples = geometric_samples(params.light, 4 * batch_lookups);
        if (!samples.empty()) {
            add_batches(c, samples, sum, exec);
            return sum;
        }
    }
    if (params.method == SpectralMethod::exact) {
        add_exact(c, exact_samples(c, params), sum, exec, progress);
    } else {
        const int count = params.wavelengths > 0 ? params.wavelengths : lookup_wavelengths;
        add_lookups(c, spectral_samples(params.light, count), sum, exec);
    }
    return sum;
}

}  // namespace obscura
