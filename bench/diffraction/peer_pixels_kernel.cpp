// Plain loops, which the compiler turns into vectors of the file's instruction set.

#include "bench/diffraction/peer_pixels.h"

namespace obscura::OBSCURA_ISA {

void power_of(const float* z, std::int32_t count, float* power) noexcept {
    for (std::int32_t i = 0; i < count; ++i)
        power[i] = z[2 * i] * z[2 * i] + z[2 * i + 1] * z[2 * i + 1];
}

void scale_row(const float* power, const float* u, float v, std::int32_t count, float* out) noexcept {
    for (std::int32_t i = 0; i < count; ++i)
        out[i] = power[i] * u[i] * v;
}

void scale_reversed(const float* power, const float* u, float v, std::int32_t count, float* out) noexcept {
    for (std::int32_t i = 0; i < count; ++i)
        out[i] = power[-i] * u[i] * v;
}

void multiply_row(float* z, const float* w, float re, float im, std::int32_t count) noexcept {
    for (std::int32_t i = 0; i < count; ++i) {
        const float w_re = w[2 * i] * re - w[2 * i + 1] * im, w_im = w[2 * i] * im + w[2 * i + 1] * re;
        const float z_re = z[2 * i], z_im = z[2 * i + 1];
        z[2 * i] = z_re * w_re - z_im * w_im;
        z[2 * i + 1] = z_re * w_im + z_im * w_re;
    }
}

void split_row(const float* z, std::int32_t count, float* re, float* im) noexcept {
    for (std::int32_t i = 0; i < count; ++i) {
        re[i] = z[2 * i];
        im[i] = z[2 * i + 1];
    }
}

}  // namespace obscura::OBSCURA_ISA
