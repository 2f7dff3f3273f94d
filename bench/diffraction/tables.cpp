// The thesis's Tables 3.1 to 3.3 on its apertures: quads, culling and symmetry, spectral modes.

#include <fmt/format.h>

#include <algorithm>

#include "bench/diffraction/cases.h"
#include "bench/diffraction/diffraction_bench.h"
#include "optics/aperture_shapes.h"
#include "optics/far_field.h"
#include "optics/field/quads.h"
#include "optics/spectrum.h"
#include "optics/thesis/spectral_lookup.h"

namespace obscura {
namespace {

constexpr const char* table_aperture = "heptagon";

/// The frequencies of a whole plane of N x N pixels, for a mask of N / 2.
FrequencyGrid plane_of(int size) {
    return centred_grid(size, size, 2.0 / size);
}

}  // namespace

namespace {

/// How many quads a shape needs depends on its size and on how it lies on the grid. The thesis says neither;
/// these give its counts.
ApertureShape counted_shape(ApertureKind kind) {
    ApertureShape shape;
    shape.kind = kind;
    switch (kind) {
        case ApertureKind::box:
            // On the grid of 128, but for the right and lower edges, 0.8 texels of the grid of 1024 farther
            // out.
            shape.diameter = 72.1 / 128;
            shape.offset_x = shape.offset_y = 0.05 / 128;
            break;
        case ApertureKind::circle:
            shape.diameter = 0.47;
            break;
        case ApertureKind::iris:
            shape.diameter = 0.77;
            break;
        default:
            shape.diameter = 0.43;
    }
    return shape;
}

std::int64_t quad_count(const Aperture& image, int levels) {
    return static_cast<std::int64_t>(quads_of(reduce(image, levels, true).mask.view()).size());
}

}  // namespace

std::vector<QuadRow> measure_quads(const DiffractionBenchPlan& plan) {
    const std::pair<const char*, ApertureKind> apertures[] = {{"box", ApertureKind::box},
                                                              {"circle", ApertureKind::circle},
                                                              {"heptagon", ApertureKind::iris},
                                                              {"whirl", ApertureKind::whirl}};
    std::vector<QuadRow> rows;
    for (const auto& [name, kind] : apertures) {
        for (const int size : plan.sizes) {
            const Aperture image = make_aperture(counted_shape(kind), size, 0.01);
            rows.push_back({name, size, quad_count(image, 1), quad_count(image, 2)});
        }
    }
    return rows;
}

std::vector<CullRow> measure_culling(const DiffractionBenchPlan& plan) {
    constexpr double dark = 1e-6;  // share of the peak
    std::vector<CullRow> rows;
    for (const int size : plan.sizes) {
        const Aperture mask = diffraction_case(table_aperture, size, {})->mask;
        CullRow row;
        row.size = size;
        std::vector<TimedJob> jobs;
        std::vector<double*> results = {&row.plain_ms, &row.cull_ms, &row.symmetry_ms, &row.both_ms};
        FarFieldReport report;
        for (const bool symmetry : {false, true}) {
            for (const double cull : {0.0, dark}) {
                const FarFieldParams params{FarFieldMethod::edges, symmetry, cull};
                jobs.push_back({"edges", [&mask, &report, size, params] {
                                    FarFieldReport done;
                                    far_field_power(mask, plane_of(size), params, {best_isa(), 1}, &done);
                                    if (params.cull > 0 && !params.symmetry) report = done;
                                }});
            }
        }
        const std::vector<Timing> timings = time_interleaved(jobs, plan.timing);
        for (std::size_t i = 0; i < results.size(); ++i)
            *results[i] = timings[i].least_ms;
        row.active = static_cast<double>(report.active_blocks) / static_cast<double>(report.blocks);
        rows.push_back(row);
    }
    return rows;
}

namespace {

constexpr double reference_nm = 550;

/// Sixty lookups.
void full_spectrum(const PowerImage& from, const std::vector<SpectralSample>& samples, Image<Vec3f>& sum,
                   const Exec& exec) {
    for (const SpectralSample& sample : samples)
        add_scaled_power(from, from.grid, reference_nm / sample.wavelength_nm, sample.rgb,
                         PowerInterpolation::linear, sum, exec);
}

/// Four scales gathered, then fifteen lookups of four.
void batch_spectrum(const PowerImage& from, const std::vector<SpectralSample>& samples, Image<Vec3f>& sum,
                    const Exec& exec) {
    double ladder[4];
    for (std::size_t i = 0; i < 4; ++i)
        ladder[i] = samples[0].wavelength_nm / samples[i].wavelength_nm;
    const PowerBatch batch = gather_batch(from, from.grid, ladder, PowerInterpolation::linear, exec);
    for (std::size_t first = 0; first + 4 <= samples.size(); first += 4) {
        const Vec3d weights[4] = {samples[first].rgb, samples[first + 1].rgb, samples[first + 2].rgb,
                                  samples[first + 3].rgb};
        add_scaled_batch(batch, from.grid, reference_nm / samples[first].wavelength_nm, weights,
                         PowerInterpolation::linear, sum, exec);
    }
}

}  // namespace

std::vector<SpectralRow> measure_spectra(const DiffractionBenchPlan& plan) {
    constexpr int largest_size = 1024, wavelengths = 60;
    const Exec exec{best_isa(), 1};
    const std::vector<SpectralSample> samples = geometric_samples(LightSpectrum{}, wavelengths);
    std::vector<SpectralRow> rows;
    for (const int size : plan.sizes) {
        if (size > largest_size) continue;
        const Aperture mask = diffraction_case(table_aperture, size, {})->mask;
        const PowerImage power{plane_of(size), far_field_power(mask, plane_of(size), {}, Exec{})};
        Image<Vec3f> sum(size, size);
        const std::vector<Timing> timings =
            time_interleaved({{"full", [&] { full_spectrum(power, samples, sum, exec); }},
                              {"batch", [&] { batch_spectrum(power, samples, sum, exec); }}},
                             plan.timing);
        rows.push_back({size, timings[0].least_ms, timings[1].least_ms});
    }
    return rows;
}

}  // namespace obscura
