#include "app/frame/glare_memory.h"

#include <algorithm>
#include <cmath>

#include "app/frame/hidden_lamps.h"
#include "app/frame/lens.h"
#include "app/frame/source_kernels.h"

namespace obscura {
namespace {

// Those of optics/psf.cpp and optics/pixel_integrals.cpp.
constexpr double shortest_m = 360e-9;
constexpr std::int64_t finest_mask = 4096;
constexpr double faithful_cycles_per_texel = 0.25;
constexpr std::int64_t cells_per_band = std::int64_t{1} << 22;
constexpr std::int64_t least_columns_per_band = 128;
constexpr double most_rows = 371'000;  // of 2^36 frequencies

constexpr std::int64_t real = sizeof(float);

/// Width of a pixel in cycles of the pupil, at the shortest wavelength.
double cycles_per_pixel(const OpticsSettings& optics, const RenderSettings& render) {
    return pixel_m(optics, render) / (shortest_m * optics.f_number);
}

std::int64_t mask_side(const OpticsSettings& optics) {
    return optics.from_file ? std::max(optics.mask.width, optics.mask.height) : optics.mask_px;
}

/// Cells of power that are summed at a time. They are not narrower than a 16th of a pixel (less for fine
/// tolerances) or, where pixels span many fringes, a quarter of a cycle of the pupil.
std::int64_t band_cells(const OpticsSettings& optics, const RenderSettings& render) {
    const double finer = std::max(1.0, std::sqrt(0.01 / optics.tolerance));
    const double per_pixel = std::max(16 * finer, 4 * cycles_per_pixel(optics, render));
    const double reach = (2.0 * optics.radius_px + 1) * per_pixel * 1.6 + 5;  // 550 nm / shortest
    const auto rows = static_cast<std::int64_t>(std::min(reach, most_rows));
    return std::min(std::max(cells_per_band, least_columns_per_band * rows) + rows, rows * (rows + 5) / 2);
}

/// A far field's pattern: masks and their spectra, power and its sums, colours in double, kernels in float.
std::int64_t pattern_bytes(const OpticsSettings& optics, const RenderSettings& render) {
    const std::int64_t side = kernel_side(optics), own = mask_side(optics),
                       fine = finest_mask_side(optics, render);
    const std::int64_t masks = 4 * own * own * real + 4 * fine * fine * real;
    const std::int64_t cells = band_cells(optics, render) * std::int64_t{3 * sizeof(float) + sizeof(double)};
    return masks + cells + side * side * std::int64_t{2 * (sizeof(Vec3d) + sizeof(Vec3f))};
}

/// A near field's: nine samples a pixel, of one wavelength and of all, and tables along both axes.
std::int64_t defocus_bytes(const OpticsSettings& optics) {
    if (!(optics.focus_m > 0)) return 0;
    const std::int64_t side = kernel_side(optics), plane = 3 * side, mask = mask_side(optics) + 1;
    const std::int64_t tables = 3 * plane * mask * 2 * real;
    return plane * plane * std::int64_t{sizeof(Vec3f) + sizeof(float)} + tables + 4 * mask * mask * real +
           2 * side * side * std::int64_t{sizeof(Vec3f)};
}

/// Kernels that are kept until the light is spread.
std::int64_t kernel_count(const OpticsSettings& optics, std::int64_t pixels, std::int64_t lamps) {
    std::int64_t own = optics.focus_m > 0 ? optics.focus_steps : 0;
    if (optics.visibility != PupilVisibility::open) own += lamps * optics.visibility_samples;
    // The open lens's is kept for the next frame, too.
    return 2 + std::min({own, pixels, static_cast<std::int64_t>(most_kernels) - 1});
}

}  // namespace

std::int64_t finest_mask_side(const OpticsSettings& optics, const RenderSettings& render) {
    std::int64_t side = mask_side(optics);
    if (optics.from_file) return side;
    const double highest = (optics.radius_px + 0.5) * cycles_per_pixel(optics, render);
    while (highest / static_cast<double>(side) > faithful_cycles_per_texel && 2 * side <= finest_mask)
        side *= 2;
    return side;
}

std::int64_t glare_bytes(const OpticsSettings& optics, const RenderSettings& render, std::int64_t lamps) {
    if (!optics.enabled) return 0;
    const std::int64_t side = kernel_side(optics), pixels = std::int64_t{render.width} * render.height;
    std::int64_t kept = side * side * std::int64_t{sizeof(Vec3f)} * kernel_count(optics, pixels, lamps);
    if (wants_source_kernels(optics)) {
        // Which kernel a pixel takes; points of lamps (lists may grow to twice their size), what they see.
        kept += pixels * std::int64_t{sizeof(std::uint16_t)};
        if (optics.visibility != PupilVisibility::open) kept += pixels * bytes_per_lamp_pixel;
    }
    return kept + std::max({pattern_bytes(optics, render), defocus_bytes(optics),
                            most_glare(render.width, render.height, kernel_side(optics),
                                       glare_params(optics, render))
                                .bytes});
}

}  // namespace obscura
