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
#include <cstring>

#include "optics/field/separable_field.h"

namespace obscura {
namespace {

/// Amplitude error of a fresh field, as a share of the open area; of a product, as a share of the area that
/// its terms cover.
constexpr double fresh_error = 1e-6;
/// Half a unit in the last place of two numbers below 1, combined.
constexpr double rounding_error = 8.5e-8;

/// Texels in which two masks differ lie in [x0, x1) x [y0, y1).
struct Changed {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

Changed changed_texels(ImageView<const float> after, const Image<float>& before) {
    Changed box{after.width, after.height, 0, 0};
    for (int y = 0; y < after.height; ++y) {
        const float *to = after.row(y), *from = before.row(y);
        if (std::memcmp(to, from, static_cast<std::size_t>(after.width) * sizeof(float)) == 0) continue;
        box.y0 = std::min(box.y0, y);
        box.y1 = y + 1;
        int first = 0, last = after.width - 1;
        while (first < last && to[first] == from[first])
            ++first;
        while (last > first && to[last] == from[last])
            --last;
        box.x0 = std::min(box.x0, first);
        box.x1 = std::max(box.x1, last + 1);
    }
    return box;
}

Image<float> difference_of(ImageView<const float> after, const Image<float>& before, const Changed& box) {
    Image<float> difference(std::max(0, box.x1 - box.x0), std::max(0, box.y1 - box.y0));
    for (int y = 0; y < difference.height; ++y) {
        const float *to = after.row(box.y0 + y) + box.x0, *from = before.row(box.y0 + y) + box.x0;
        float* out = difference.row(y);
        for (int x = 0; x < difference.width; ++x)
            out[x] = to[x] - from[x];
    }
    return difference;
}

void move(IntervalTerms& terms, double by) {
    for (auto* ends : {&terms.x0, &terms.x1}) {
        for (double& x : *ends)
            x += by;
    }
}

/// Terms of a part of a mask, about the whole mask's centre.
SeparableTerms terms_of(const Image<float>& difference, const Changed& box, ImageView<const float> whole) {
    SeparableTerms terms = separable_terms(difference.view());
    move(terms.x, box.x0 + (difference.width - whole.width) * 0.5);
    move(terms.y, box.y0 + (difference.height - whole.height) * 0.5);
    return terms;
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

void refresh(FarFieldProgress& progress, ImageView<const float> mask, double area, const Exec& exec) {
    Aperture aperture;
    aperture.mask = copy_of(mask);
    const FrequencyGrid& grid = progress.grid;
    FarFieldReport done;
    if (progress.field.re.width != grid.width || progress.field.re.height != grid.height)
        progress.field = {Image<float>(grid.width, grid.height), Image<float>(grid.width, grid.height)};
    far_field_into(aperture, grid, {},
                   {progress.field.re.pixels.data(), progress.field.im.pixels.data(), nullptr, grid.width},
                   exec, &done);
    progress.refresh_ms = done.cost_ms;
    progress.mask = std::move(aperture.mask);
    progress.field_grid = grid;
    progress.error_bound = fresh_error * area;
}

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

/// Of adding the terms of a difference to a field, nanoseconds on one thread.
double update_cost_ns(const SeparableTerms& difference, const FrequencyGrid& grid) {
    return separable_cost_ns(difference, grid) + 0.5 * grid.width * grid.height;
}

}  // namespace

ProgressReport update_far_field(FarFieldProgress& progress, ImageView<const float> mask, const Exec& exec) {
    const double area = open_area(mask);
    const FrequencyGrid& grid = progress.grid;
    Field& field = progress.field;
    ProgressReport report;
    if (progress.mask.width != mask.width || progress.mask.height != mask.height ||
        progress.field_grid != grid) {
        report.refreshed = true;
        report.reason = "computed anew: the first of its size and grid";
    } else {
        const Changed box = changed_texels(mask, progress.mask);
        const Image<float> difference = difference_of(mask, progress.mask, box);
        const SeparableTerms terms = terms_of(difference, box, mask);
        const double bound =
            progress.error_bound + fresh_error * absolute_area(difference) + rounding_error * area;
        report.terms = terms.count();
        report.refresh_ms = progress.refresh_ms;
        report.update_ms = update_cost_ns(terms, grid) * 1e-6;
        decide(progress, bound, area, report);
        if (!report.refreshed && terms.count() > 0) {
            SeparableParams params;
            params.add = true;
            const FieldTarget target{field.re.pixels.data(), field.im.pixels.data(), nullptr, grid.width};
            separable_field(terms, grid, params, target, exec);
            for (int y = box.y0; y < box.y1; ++y)
                std::copy_n(mask.row(y), mask.width, progress.mask.row(y));
            progress.error_bound = bound;
        }
    }
    if (report.refreshed) {
        refresh(progress, mask, area, exec);
        report.refresh_ms = progress.refresh_ms;
    }
    report.error_bound = area > 0 ? progress.error_bound / area : 0;
    return report;
}

}  // namespace obscura
