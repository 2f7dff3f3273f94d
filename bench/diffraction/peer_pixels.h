#pragma once
// What follows an FFT on its way to pixels, at the speed that each machine allows: the peer's loops, too, are
// compiled once per instruction set. Complex numbers: real and imaginary parts by turns. POD.
//
// Bits of multiply_row differ between instruction sets: g++ 12 makes vfmaddsub of products of interleaved
// complex numbers even where -ffp-contract=off. A peer may have that; our own kernels, which may not, keep
// real and imaginary parts apart.

#include <cstdint>

namespace obscura {

/// power_of:       power[i] = |z[i]|^2.
/// scale_row:      out[i] = power[i] * u[i] * v.
/// scale_reversed: out[i] = power[-i] * u[i] * v.
/// multiply_row:   z[i] = z[i] * w[i] * (re, im).
/// split_row:      re[i], im[i] = parts of z[i].
#define OBSCURA_PEER_PIXELS                                                                               \
    void power_of(const float* z, std::int32_t count, float* power) noexcept;                             \
    void scale_row(const float* power, const float* u, float v, std::int32_t count, float* out) noexcept; \
    void scale_reversed(const float* power, const float* u, float v, std::int32_t count,                  \
                        float* out) noexcept;                                                             \
    void multiply_row(float* z, const float* w, float re, float im, std::int32_t count) noexcept;         \
    void split_row(const float* z, std::int32_t count, float* re, float* im) noexcept;
namespace sse2 {
OBSCURA_PEER_PIXELS
}
namespace avx2 {
OBSCURA_PEER_PIXELS
}
namespace avx512bw {
OBSCURA_PEER_PIXELS
}
namespace ref {
OBSCURA_PEER_PIXELS
}
#undef OBSCURA_PEER_PIXELS

}  // namespace obscura
