#include "optics/thesis/scaled_intensity.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"

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

}  // namespace obscura
