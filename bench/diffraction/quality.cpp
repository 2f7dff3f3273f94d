// What coarser masks do to pictures (thesis, Figures 3.8 and 3.9): structural similarity and PSNR of the
// patterns of the finest level, half the image's side, and of the aggressive one, a quarter, against the
// exact pattern of the anti-aliased image.

#include <algorithm>

#include "bench/diffraction/cases.h"
#include "bench/diffraction/diffraction_bench.h"
#include "filters/metrics.h"
#include "optics/far_field.h"
#include "optics/field/quads.h"
#include "optics/near_field.h"

namespace obscura {
namespace {

constexpr double near_fresnel_number = 10;

/// Power relative to that at frequency 0, in steps of the image's natural grid; shown with the brightest part
/// clipped at 1e-4 of the peak, so that rings are seen.
Image<float> shown_far_field(const Aperture& aperture, int size, double texels_per_image_texel) {
    const double area = open_area(aperture.mask.view());
    Image<float> power =
        far_field_power(aperture, centred_grid(size, size, texels_per_image_texel / size), {}, Exec{});
    const auto scale = static_cast<float>(1e4 / (area * area));
    for (float& value : power.pixels)
        value = std::min(1.0f, value * scale);
    return power;
}

/// Intensity over the image's square, one pixel per texel of the image.
Image<float> shown_near_field(const Aperture& aperture, int size) {
    NearFieldParams params;
    params.distance_m = 1;
    params.distance_m = fresnel_number(aperture, params) / near_fresnel_number;
    return near_field_intensity(aperture, centred_plane(size, aperture.mask.width), params, Exec{});
}

QualityRow compared(const Image<float>& exact, const Image<float>& coarse) {
    const float peak = *std::max_element(exact.pixels.begin(), exact.pixels.end());
    const ImageDifference difference =
        compare_images({exact}, {coarse}, {static_cast<double>(peak), 0.0}, Exec{});
    QualityRow row;
    row.ssim = difference.ssim;
    row.psnr_db = difference.psnr_db;
    return row;
}

}  // namespace

std::vector<QualityRow> measure_quality(const DiffractionBenchPlan& plan, const BenchOptions& options) {
    const int size = plan.quality_size;
    std::vector<QualityRow> rows;
    for (const std::string& name : chosen_apertures(options)) {
        const auto shape = diffraction_case(name, size, options.data);
        if (!shape) continue;
        const Image<float> far = shown_far_field(shape->image, size, 1),
                           near = shown_near_field(shape->image, size);
        for (const int level : {1, 2}) {
            const Aperture mask = reduce(shape->image, level, true);
            const auto quads = static_cast<std::int64_t>(quads_of(mask.mask.view()).size());
            for (const bool is_far : {true, false}) {
                QualityRow row = is_far ? compared(far, shown_far_field(mask, size, 1 << level))
                                        : compared(near, shown_near_field(mask, size));
                row.field = is_far ? far_part : near_part;
                row.aperture = name;
                row.size = size;
                row.level = level == 1 ? "finest" : "aggressive";
                row.quads = quads;
                rows.push_back(row);
            }
        }
    }
    return rows;
}

}  // namespace obscura
