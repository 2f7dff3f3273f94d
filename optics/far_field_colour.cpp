// The coloured far field.
//
// L. Scandolo: thesis, 2019, section 3.4.3, equations 3.15 to 3.17. The paper looks one pattern up at 60
// scales, or four at a time. The default, `exact`, computes each wavelength's pattern on its own grid, since
// it costs little more here and bilinear lookups are the larger error.

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "optics/aperture_extent.h"
#include "optics/psf.h"
#include "optics/thesis/scaled_colours.h"

namespace obscura {

namespace {

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

/// How they are added up: lines have no even ladder of wavelengths, so batches of four look them up singly.
SpectralMethod method_for(const PsfParams& params) {
    const bool lines = params.method == SpectralMethod::batch && geometric_samples(params.light, 4).empty();
    return lines ? SpectralMethod::lookup : params.method;
}

std::vector<SpectralSample> samples_of(const Colouring& c, const PsfParams& params) {
    switch (method_for(params)) {
        case SpectralMethod::batch:
            return geometric_samples(params.light, 4 * batch_lookups);
        case SpectralMethod::lookup:
            return spectral_samples(params.light, params.wavelengths > 0 ? params.wavelengths : full_lookups);
        case SpectralMethod::exact:
            break;
    }
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

/// The wavelengths as one pattern scaled.
std::vector<ScaledColour> scaled_colours(const Colouring& c, const std::vector<SpectralSample>& samples) {
    const std::vector<Vec3d> weights = weights_of(c, samples);
    std::vector<ScaledColour> colours;
    for (std::size_t i = 0; i < samples.size(); ++i)
        colours.push_back({scale_of(c, samples[i]), weights[i]});
    return colours;
}

/// Where that pattern is computed: at least twice as finely as power needs.
FrequencyGrid pattern_grid_for(const Colouring& c, const std::vector<ScaledColour>& colours) {
    return pattern_grid(c.grid, colours, lookup_step(open_extent(c.aperture.mask.view())));
}

Colouring colouring_of(const Aperture& aperture, const FrequencyGrid& grid, double reference_nm,
                       const PsfParams& params) {
    if (!(reference_nm >= 100 && reference_nm <= 10000))
        throw InputError("", "reference wavelength must be 100 to 10000 nm");
    check_sampling(params.wavelengths, params.tolerance);
    const Colouring c{aperture, grid, reference_nm, open_area(aperture.mask.view()), params.light};
    if (!(c.peak > 0)) throw InputError("aperture", "lets no light through");
    return c;
}

}  // namespace

const char* spectral_method_name(SpectralMethod method) {
    switch (method) {
        case SpectralMethod::exact:
            return "exact";
        case SpectralMethod::lookup:
            return "full60";
        case SpectralMethod::batch:
            return "batch4";
    }
    return "?";
}

ColourPlan plan_far_field_colour(const Aperture& aperture, const FrequencyGrid& grid, double reference_nm,
                                 const PsfParams& params) {
    const Colouring c = colouring_of(aperture, grid, reference_nm, params);
    const std::vector<SpectralSample> samples = samples_of(c, params);
    ColourPlan plan;
    plan.wavelengths = static_cast<int>(samples.size());
    const SpectralMethod method = method_for(params);
    if (method == SpectralMethod::exact) {
        plan.pattern = plan_far_field(aperture, grid_of(c, samples[samples.size() / 2]), {});
        plan.cost_ms = plan.wavelengths * plan.pattern.cost_ms;
        return plan;
    }
    const FrequencyGrid pattern = pattern_grid_for(c, scaled_colours(c, samples));
    plan.pattern = plan_far_field(aperture, pattern, {});
    plan.looked_up = std::int64_t{pattern.width} * pattern.height * (method == SpectralMethod::batch ? 5 : 1);
    return plan;
}

Image<Vec3f> far_field_colour(const Aperture& aperture, const FrequencyGrid& grid, double reference_nm,
                              const PsfParams& params, const Exec& exec,
                              const std::function<void(double)>& progress) {
    const Colouring c = colouring_of(aperture, grid, reference_nm, params);
    const std::vector<SpectralSample> samples = samples_of(c, params);
    Image<Vec3f> sum(grid.width, grid.height);
    const SpectralMethod method = method_for(params);
    if (method == SpectralMethod::exact) {
        add_exact(c, samples, sum, exec, progress);
        return sum;
    }
    const std::vector<ScaledColour> colours = scaled_colours(c, samples);
    PowerImage pattern{pattern_grid_for(c, colours), {}};
    pattern.power = far_field_power(aperture, pattern.grid, {}, exec);
    if (method == SpectralMethod::batch)
        add_colours_in_batches(pattern, grid, colours, sum, exec);
    else
        add_colours(pattern, grid, colours, sum, exec);
    return sum;
}

}  // namespace obscura
