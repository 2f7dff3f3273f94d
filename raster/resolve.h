#pragma once
// From planes of samples' radiance to pixels (ref, sse2, avx2, avx512bw).

#include <cstdint>

namespace obscura {

/// rgb[3 i ..] = (r[i], g[i], b[i]) * scale for i in [0, count).
#define OBSCURA_RESOLVE_PIXELS                                                                           \
    void resolve_pixels(const float* r, const float* g, const float* b, std::int32_t count, float scale, \
                        float* rgb) noexcept;
namespace ref {
OBSCURA_RESOLVE_PIXELS
}
namespace sse2 {
OBSCURA_RESOLVE_PIXELS
}
namespace avx2 {
OBSCURA_RESOLVE_PIXELS
}
namespace avx512bw {
OBSCURA_RESOLVE_PIXELS
}
#undef OBSCURA_RESOLVE_PIXELS

}  // namespace obscura
