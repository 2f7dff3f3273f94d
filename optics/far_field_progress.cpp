// Progressive far fields.
//
// L. Scandolo: Compression and rendering with image-based representations (thesis, 2019), section 3.4.3,
// "Progressive Refinement": the transform is linear, so the transform of what opened less that of what closed
// turns the last frame's pattern into this one's. The paper cuts the difference into positive and negative
// quads. Here it is a mask of its own, and its distinct columns are multiplied as far_field_edges() does:
// fewer products than quads would need.
//
// Two things the paper leaves open. Sums of floats drift: each update adds at most the product's own error
// and half a unit in the last place of the sum, which is counted, and past a tolerance the field is computed
// anew. And a difference with many distinct columns costs more than starting anew does: a model decides.

#include "optics/far_field_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optics/far_field_costs.h"
#include "optics/separable_field.h"

namespace obscura {
namespace {

/// Amplitude error of a fresh field, as a share of the open area; of a product, as a share of the area that
/// its terms cover.
constexpr double fresh_error = 1e-6;
/// Half a unit in the last place of two numbers below 1, combined.
constexpr double rounding_error = 8.5e-8;

Image<float> difference_of(ImageView<const float> after, const Image<float>& before) {
    Image<float> difference(after.width, after.height);
    for (int y = 0; y < after.height; ++y) {
        const float *to = after.row(y), *from = before.row(y);
        float* out = difference.row(y);
        for (int x = 0; x < after.width; ++x)
            out[x] = to[x] - from[x];
    }
    return difference;
}

Image<float> copy_of(ImageView<const float> mask) {
    Image<float> copy(mask.width, mask.height);
    for (int y = 0; y < mask.height; ++y)
        std::copy_n(mask.row(y), mask.width, copy.row(y));
    return copy;
}

double absolute_area(const Image<float>& mask) {
    double sum = 0;
    for (const float texel : mask.pixels)
        sum += static_cast<double>(std::fabs(texel));
    return sum;
}

void refresh(FarFieldProgress& progress, Aperture&& aperture, double area, const Exec& exec) {
    const FrequencyGrid& grid = progress.grid;
    progress.field = {Image<float>(grid.width, grid.height), Image<float>(grid.width, grid.height)};
    far_field_into(aperture, grid, {},
                   {progress.field.re.pixels.data(), progress.field.im.pixels.data(), nullptr, grid.width},
                   exec);
    progress.mask = std::move(aperture.mask);
    progress.error_bound = fresh_error * area;
}

}  // namespace

double far_field_update_cost_ns(const SeparableTerms& difference, const FrequencyGrid& grid) {
    return separable_cost_ns(difference, grid) + 1.0 * grid.width * grid.height;
}

namespace {

/// Whether to add the difference or start anew, and why. `bound`: error in texels^2 if it is added.
void decide(const FarFieldProgress& progress, double bound, double area, ProgressReport& report) {
    report.refreshed = true;
    if (report.terms == 0) {
        report.refreshed = false;
        report.reason = "kept: nothing changed";
    } else if (bound > progress.tolerance * area) {
        report.reason =
            fmt::format("computed anew: the error could reach {:.1e} of the open area, above {:.1e}",
                        area > 0 ? bound / area : 1.0, progress.tolerance);
    } else if (report.update_ms > report.refresh_ms) {
        report.reason = fmt::format("computed anew: {:.2f} ms, adding the difference {:.2f} ms",
                                    report.refresh_ms, report.update_ms);
    } else {
        report.refreshed = false;
        report.reason = fmt::format("added the difference: {:.2f} ms, computing anew {:.2f} ms",
                                    report.update_ms, report.refresh_ms);
    }
}

}  // namespace

ProgressReport update_far_field(FarFieldProgress& progress, ImageView<const float> mask, const Exec& exec) {
    const double area = open_area(mask);
    const FrequencyGrid& grid = progress.grid;
    Field& field = progress.field;
    Aperture aperture;
    aperture.mask = copy_of(mask);
    ProgressReport report;
    report.refresh_ms = plan_far_field(aperture, grid, {}).cost_ms;
    if (progress.mask.width != mask.width || progress.mask.height != mask.height ||
        field.re.width != grid.width || field.re.height != grid.height) {
        report.refreshed = true;
        report.reason = "computed anew: the first of its size";
    } else {
        const Image<float> difference = difference_of(mask, progress.mask);
        const SeparableTerms terms = separable_terms(difference.view());
        const double bound =
            progress.error_bound + fresh_error * absolute_area(difference) + rounding_error * area;
        report.terms = terms.count();
        report.update_ms = far_field_update_cost_ns(terms, grid) * 1e-6;
        decide(progress, bound, area, report);
        if (!report.refreshed && terms.count() > 0) {
            SeparableParams params;
            params.add = true;
            const FieldTarget target{field.re.pixels.data(), field.im.pixels.data(), nullptr, grid.width};
            separable_field(terms, grid, params, target, exec);
            progress.mask = std::move(aperture.mask);
            progress.error_bound = bound;
        }
    }
    if (report.refreshed) refresh(progress, std::move(aperture), area, exec);
    report.error_bound = area > 0 ? progress.error_bound / area : 0;
    return report;
}

}  // namespace obscura
