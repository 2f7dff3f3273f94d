// Planes to pixels, sixteen at a time.

#include "core/simd_vec.h"
#include "raster/resolve.h"

namespace obscura::OBSCURA_ISA {

void resolve_pixels(const float* r, const float* g, const float* b, std::int32_t count, float scale,
                    float* rgb) noexcept {
    std::int32_t i = 0;
    for (; i + lanes <= count; i += lanes)
        store_interleaved(rgb + 3 * i, load3(r + i, g + i, b + i) * splat(scale));
    for (; i < count; ++i) {
        rgb[3 * i] = r[i] * scale;
        rgb[3 * i + 1] = g[i] * scale;
        rgb[3 * i + 2] = b[i] * scale;
    }
}

}  // namespace obscura::OBSCURA_ISA
