#include "optics/near_field_colour.h"

#include <vector>

#include "core/parallel.h"
#include "optics/thesis/scaled_intensity.h"

namespace obscura {
namespace {

void add_colour(Image<Vec3f>& sum, const Image<float>& power, Vec3d rgb, const Exec& exec) {
    const Vec3f colour{static_cast<float>(rgb.x), static_cast<float>(rgb.y), static_cast<float>(rgb.z)};
    parallel_for(static_cast<std::size_t>(sum.height), exec, [&](std::size_t row) {
        const auto y = static_cast<int>(row);
        for (int x = 0; x < sum.width; ++x)
            sum(x, y) = sum(x, y) + colour * power(x, y);
    });
}

}  // namespace

const char* near_field_colour_name(NearFieldColour how) {
    return how == NearFieldColour::exact ? "exact" : "scaled";
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
