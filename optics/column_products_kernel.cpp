// Sixteen columns between a transform and a picture. See column_products_ref.cpp.

#include "optics/column_products.h"

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

void multiply16(const float* from_re, const float* from_im, const float* factor_re, const float* factor_im,
                int count, float* to_re, float* to_im) noexcept {
    for (int k = 0; k < count; ++k) {
        const F32 a = load(from_re + 16 * k), b = load(from_im + 16 * k);
        const F32 c = splat(factor_re[k]), d = splat(factor_im[k]);
        store(to_re + 16 * k, a * c - b * d);
        store(to_im + 16 * k, a * d + b * c);
    }
}

void store_rows16(const float* re, const float* im, const RowStore& rows,
                  const FieldTarget& target) noexcept {
    for (int k = 0; k < rows.count; ++k) {
        const std::ptrdiff_t from = 16 * (rows.first_element + k * rows.element_step);
        const std::ptrdiff_t row = (rows.first_row + k * rows.row_step) * target.stride + rows.x;
        const F32 a = load(re + from), b = load(im + from);
        if (target.re != nullptr) store(target.re + row, a);
        if (target.im != nullptr) store(target.im + row, b);
        if (target.power != nullptr) store(target.power + row, a * a + b * b);
    }
}

void store_products16(const float* re, const float* im, const float* factor_re, const float* factor_im,
                      int count, int column, int used, const FieldTarget& target) noexcept {
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
