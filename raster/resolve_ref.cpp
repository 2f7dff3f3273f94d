// Planes to pixels, one at a time.

#include "raster/resolve.h"

namespace obscura::ref {

void resolve_pixels(const float* r, const float* g, const float* b, std::int32_t count, float scale,
                    float* rgb) noexcept {
    for (std::int32_t i = 0; i < count; ++i) {
        rgb[3 * i] = r[i] * scale;
        rgb[3 * i + 1] = g[i] * scale;
        rgb[3 * i + 2] = b[i] * scale;
    }
}

}  // namespace obscura::ref
