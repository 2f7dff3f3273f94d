// Planes to pixels, sixteen at a time.

#include "core/simd_vec.h"
#include "raster/resolve.h"

namespace obscura::OBSCURA_ISA {

void resolve_pixels(const float* r, const float* g, const float* b, std::int32_t count, float scale,
                    float* rgb) noexcept {
    // A picture is larger than the caches: written past them, its lines need not be read first.
    const bool aligned = (reinterpret_cast<std::uintptr_t>(rgb) & 63) == 0;
    std::int32_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        const Vec3x16 pixels = interleaved(load3(r + i, g + i, b + i) * splat(scale));
        float* out = rgb + 3 * i;
        if (aligned) {
            store_streaming(out, pixels.x);
            store_streaming(out + 16, pixels.y);
            store_streaming(out + 32, pixels.z);
        } else {
            store3(out, out + 16, out + 32, pixels);
        }
    }
    for (; i < count; ++i) {
        rgb[3 * i] = r[i] * scale;
        rgb[3 * i + 1] = g[i] * scale;
        rgb[3 * i + 2] = b[i] * scale;
    }
}

}  // namespace obscura::OBSCURA_ISA
