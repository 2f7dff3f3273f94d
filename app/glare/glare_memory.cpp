#include "app/glare/glare_memory.h"

#include <algorithm>

#include "app/glare/glare_margin.h"
#include "app/glare/hidden_lamps.h"
#include "app/glare/lamp_pixels.h"
#include "app/glare/lens.h"
#include "app/glare/source_kernels.h"
#include "core/error.h"
#include "optics/psf_memory.h"

namespace obscura {
namespace {

constexpr std::int64_t real = sizeof(float);
constexpr std::int64_t pixels_per_bright_one = 16;

std::int64_t kernel_bytes(const OpticsSettings& optics) {
    const std::int64_t side = kernel_side(optics);
    return side * side * std::int64_t{sizeof(Vec3f)};
}

/// A far field's pattern; lamps partly hidden see a mask without an outline. Files that are not read yet
/// count as nothing; a lens that is closed has no pattern, which is an error of its own where it is asked
/// for.
std::int64_t pattern_bytes(const OpticsSettings& optics, const RenderSettings& render, bool hidden) {
    if (optics.from_file && optics.mask.pixels.empty()) return 0;
    try {
        Aperture aperture = lens_aperture(optics);
        if (hidden) aperture.outline = {};
        return far_field_psf_bytes(aperture, psf_params(optics, render));
    } catch (const InputError&) {
        return 0;
    }
}

/// A near field's: nine samples a pixel, of one wavelength and of all, and tables along both axes.
std::int64_t defocus_bytes(const OpticsSettings& optics) {
    if (!(optics.focus_m > 0)) return 0;
    const std::int64_t side = kernel_side(optics), plane = 3 * side;
    const std::int64_t mask =
        1 + (optics.from_file ? std::max(optics.mask.width, optics.mask.height) : optics.mask_px);
    const std::int64_t tables = 3 * plane * mask * 2 * real;
    return plane * plane * std::int64_t{sizeof(Vec3f) + sizeof(float)} + tables + 4 * mask * mask * real +
           2 * kernel_bytes(optics);
}

}  // namespace

std::int64_t expected_kernels(const OpticsSettings& optics, std::int64_t lamps) {
    std::int64_t own = optics.focus_m > 0 ? optics.focus_steps : 0;
    if (optics.visibility != PupilVisibility::open) own += (lamps + 3) / 4 * optics.visibility_samples;
    // The open lens's is kept for the next frame, too.
    return 2 + std::min(own, static_cast<std::int64_t>(most_kernels) - 1);
}

std::int64_t glare_bytes(const OpticsSettings& optics, const RenderSettings& render, int margin_px,
                         std::int64_t lamps, std::optional<std::int64_t> bright_px) {
    if (!optics.enabled) return 0;
    const RenderSettings wide = widened(render, margin_px);
    const std::int64_t pixels = std::int64_t{wide.width} * wide.height;
    const std::int64_t bright = bright_px.value_or(pixels / pixels_per_bright_one);
    // First the open lens's pattern is made; then those of sources with their own; then the light is spread.
    const std::int64_t open = pattern_bytes(optics, render, false);
    std::int64_t own = 0, lists = 0;
    if (wants_source_kernels(optics)) {
        // Depth and object of every pixel, which kernel it takes; points of lamps, what they see.
        lists = pixels * std::int64_t{sizeof(float) + sizeof(std::uint32_t) + sizeof(std::uint16_t)};
        if (optics.visibility != PupilVisibility::open) {
            lists += bright * bytes_per_lamp_pixel;
            own = pattern_bytes(optics, render, true);
        }
    }
    // A mask out of a file is the scene's, too, and there once more while it is made square.
    lists += 2 * static_cast<std::int64_t>(optics.mask.pixels.size()) * real;
    const std::int64_t spread = spread_glare_bytes(bright, wide.width, wide.height, kernel_side(optics),
                                                   glare_params(optics, render));
    const std::int64_t kept = expected_kernels(optics, lamps) * kernel_bytes(optics) + lists;
    return std::max(open + lists, kept + std::max({own, defocus_bytes(optics), spread}));
}

std::int64_t kernels_that_fit(const Scene& scene, std::int64_t free_bytes) {
    return expected_kernels(scene.optics, lamp_count(scene)) +
           std::max<std::int64_t>(free_bytes, 0) / kernel_bytes(scene.optics);
}

}  // namespace obscura
