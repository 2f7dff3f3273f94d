#include "app/glare/defocus.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "app/glare/lamp_pixels.h"
#include "app/glare/lens.h"
#include "optics/near_field_colour.h"

namespace obscura {
namespace {

constexpr int defocus_wavelengths = 24;

/// Radius in pixels of the disc that a point shows at this vergence.
double blur_px(const OpticsSettings& optics, const RenderSettings& render, double vergence_per_m) {
    const double radians_per_px = pixel_m(optics, render) / (1e-3 * optics.focal_length_mm);
    return 0.5 * pupil_m(optics) * std::fabs(vergence_per_m) / radians_per_px;
}

/// Of a kernel's pixels, less than this is in focus.
constexpr double sharp_px = 0.5;

struct BlurredPixel {
    int x = 0, y = 0;
    double vergence_per_m = 0;
};

/// Pixels that clip and are out of focus, row by row.
std::vector<BlurredPixel> blurred_pixels(const Scene& scene, const LitPicture& picture, double clip) {
    std::vector<BlurredPixel> blurred;
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x) {
            if (!clips(picture, x, y, clip)) continue;
            const auto z = static_cast<double>(picture.depth_m(x, y));
            const double vergence = (std::isfinite(z) ? 1 / z : 0.0) - 1 / scene.optics.focus_m;
            if (blur_px(scene.optics, scene.render, vergence) >= sharp_px)
                blurred.push_back({x, y, vergence});
        }
    }
    return blurred;
}

/// Even steps from the least vergence to the largest.
struct VergenceSteps {
    double low = 0, high = 0, steps = 1;
    int of(double vergence) const {
        if (!(high > low)) return 0;
        return static_cast<int>(std::min(std::floor((vergence - low) / (high - low) * steps), steps - 1));
    }
};

}  // namespace

void add_defocus(const Scene& scene, const LitPicture& picture, double clip, const Aperture& aperture,
                 const Exec& exec, SourceKernels& to) {
    const std::vector<BlurredPixel> blurred = blurred_pixels(scene, picture, clip);
    if (blurred.empty()) return;
    const auto [least, largest] = std::minmax_element(
        blurred.begin(), blurred.end(),
        [](const BlurredPixel& a, const BlurredPixel& b) { return a.vergence_per_m < b.vergence_per_m; });
    const VergenceSteps steps{least->vergence_per_m, largest->vergence_per_m,
                              static_cast<double>(scene.optics.focus_steps)};

    // Every step has the kernel of its pixels' mean vergence.
    std::map<int, std::pair<double, std::int64_t>> sums;
    for (const BlurredPixel& pixel : blurred) {
        auto& [sum, count] = sums[steps.of(pixel.vergence_per_m)];
        sum += pixel.vergence_per_m;
        ++count;
    }
    std::map<int, std::uint16_t> kernel_of;
    for (const auto& [step, sum] : sums) {
        const double mean = sum.first / static_cast<double>(sum.second);
        if (blur_px(scene.optics, scene.render, mean) < sharp_px) continue;
        kernel_of[step] = add_kernel(defocus_kernel(aperture, scene.optics, scene.render, mean, exec), to);
    }
    for (const BlurredPixel& pixel : blurred) {
        const auto found = kernel_of.find(steps.of(pixel.vergence_per_m));
        if (found == kernel_of.end()) continue;
        to.choice(pixel.x, pixel.y) = found->second;
        ++to.hidden_sources;
    }
}

Image<Vec3f> defocus_kernel(const Aperture& aperture, const OpticsSettings& optics,
                            const RenderSettings& render, double vergence_per_m, const Exec& exec) {
    // A wave front of curvature 1 / d, seen through a lens focused on 1 / f, is a plane one at the distance
    // z = 1 / (1 / d - 1 / f) behind the same opening; a pixel at the angle a shows its point z a.
    const double z = 1 / std::fabs(vergence_per_m);
    const double metres_per_px = pixel_m(optics, render) / (1e-3 * optics.focal_length_mm) * z;
    const int side = kernel_side(optics);
    constexpr int finer = 3;  // samples along a pixel's side
    PlaneGrid plane;
    plane.width = plane.height = finer * side;
    plane.step = metres_per_px / (aperture.pitch_m * finer);
    plane.first_x = plane.first_y = -0.5 * (finer * side - 1) * plane.step;
    NearFieldParams params;
    params.distance_m = z;
    const PsfParams psf = psf_params(optics, render);
    const int count = optics.wavelengths > 0 ? optics.wavelengths : defocus_wavelengths;
    const Image<Vec3f> light =
        near_field_colour(aperture, plane, params, psf.light, count, NearFieldColour::exact, exec);
    Image<Vec3f> kernel(side, side);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            Vec3d sum;
            for (int j = 0; j < finer; ++j) {
                for (int i = 0; i < finer; ++i)
                    sum = sum + into_gamut(to_double(light(finer * x + i, finer * y + j)));
            }
            // Points nearer than the focus have not crossed over yet: their picture is upside down.
            const bool turned = vergence_per_m > 0;
            kernel(turned ? side - 1 - x : x, turned ? side - 1 - y : y) = to_float(sum);
        }
    }
    return unit_kernel(kernel);
}

}  // namespace obscura
