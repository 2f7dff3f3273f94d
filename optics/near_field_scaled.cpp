#include "optics/near_field_scaled.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"

namespace obscura {
namespace {

/// Where a pixel looks: between two others.
struct Tap {
    int low = 0, high = 0;
    float share = 0;  ///< of the higher one
};

std::vector<Tap> taps(int pixels, double first, double step, double factor) {
    std::vector<Tap> all;
    for (int i = 0; i < pixels; ++i) {
        const double at = std::clamp((factor * (first + i * step) - first) / step, 0.0, pixels - 1.0);
        const double low = std::floor(at);
        all.push_back({static_cast<int>(low), std::min(static_cast<int>(low) + 1, pixels - 1),
                       static_cast<float>(at - low)});
    }
    return all;
}

void add_colour(Image<Vec3f>& sum, const Image<float>& power, Vec3d rgb, const Exec& exec) {
    const Vec3f colour{static_cast<float>(rgb.x), static_cast<float>(rgb.y), static_cast<float>(rgb.z)};
    parallel_for(static_cast<std::size_t>(sum.height), exec, [&](std::size_t row) {
        const auto y = static_cast<int>(row);
        for (int x = 0; x < sum.width; ++x)
            sum(x, y) = sum(x, y) + colour * power(x, y);
    });
}

}  // namespace

Image<float> scaled_intensity(ImageView<const float> reference, const PlaneGrid& grid, double rho) {
    CHECK(reference.width == grid.width && reference.height == grid.height);
    const double factor = 1 + 0.05 * (1 - rho);
    const std::vector<Tap> across = taps(grid.width, grid.first_x, grid.step, factor),
                           down = taps(grid.height, grid.first_y, grid.step, factor);
    Image<float> to(grid.width, grid.height);
    for (int y = 0; y < grid.height; ++y) {
        const Tap& v = down[static_cast<std::size_t>(y)];
        const float *upper = reference.row(v.low), *lower = reference.row(v.high);
        for (int x = 0; x < grid.width; ++x) {
            const Tap& u = across[static_cast<std::size_t>(x)];
            const float a = upper[u.low] + u.share * (upper[u.high] - upper[u.low]);
            const float b = lower[u.low] + u.share * (lower[u.high] - lower[u.low]);
            to(x, y) = a + v.share * (b - a);
        }
    }
    return to;
}

Image<Vec3f> near_field_colour(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                               const LightSpectrum& light, int count, NearFieldColour how, const Exec& exec,
                               const std::function<void(double)>& progress) {
    NearFieldParams p = params;
    p.wavelength_m = near_field_reference_nm * 1e-9;
    Image<float> reference;
    if (how == NearFieldColour::scaled) reference = near_field_intensity(aperture, grid, p, exec);
    Image<Vec3f> sum(grid.width, grid.height);
    const std::vector<SpectralSample> samples = spectral_samples(light, count);
    std::size_t done = 0;
    for (const SpectralSample& s : samples) {
        p.wavelength_m = s.wavelength_nm * 1e-9;
        add_colour(sum,
                   how == NearFieldColour::exact
                       ? near_field_intensity(aperture, grid, p, exec)
                       : scaled_intensity(reference.view(), grid, near_field_reference_nm / s.wavelength_nm),
                   s.rgb, exec);
        if (progress) progress(static_cast<double>(++done) / static_cast<double>(samples.size()));
    }
    return sum;
}

}  // namespace obscura
