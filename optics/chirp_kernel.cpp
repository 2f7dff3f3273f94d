// Products of sixteen sequences with one. See chirp_ref.cpp.

#include "optics/chirp.h"

#include "core/simd.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE void store_some(float* to, const F32& value, int used) {
    if (used == 16) {
        store(to, value);
        return;
    }
    alignas(64) float all[16];
    store(all, value);
    for (int l = 0; l < used; ++l)
        to[l] = all[l];
}

}  // namespace

void scale_rows16(const float* factor_re, const float* factor_im, int count, float* re, float* im) noexcept {
    for (int k = 0; k < count; ++k) {
        const F32 a = load(re + 16 * k), b = load(im + 16 * k);
        const F32 c = splat(factor_re[k]), d = splat(factor_im[k]);
        store(re + 16 * k, a * c - b * d);
        store(im + 16 * k, a * d + b * c);
    }
}

void store_rows16(const float* re, const float* im, const float* factor_re, const float* factor_im, int count,
                  int column, int used, const FieldTarget& target) noexcept {
    for (int k = 0; k < count; ++k) {
        const F32 a = load(re + 16 * k), b = load(im + 16 * k);
        const F32 e = splat(factor_re[k]), f = splat(factor_im[k]);
        const F32 c = a * e - b * f, d = a * f + b * e;
        const std::ptrdiff_t at = k * target.stride + column;
        if (target.power != nullptr) store_some(target.power + at, c * c + d * d, used);
        if (target.re != nullptr) {
            store_some(target.re + at, c, used);
            store_some(target.im + at, d, used);
        }
    }
}

}  // namespace obscura::OBSCURA_ISA
