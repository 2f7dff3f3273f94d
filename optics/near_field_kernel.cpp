// Sums of edges, products of spectra, rows of pixels. See near_field_ref.cpp.

#include "optics/near_field_kernels.h"

#include "core/simd.h"

namespace obscura::OBSCURA_ISA {

void sum_lines16(const LineSums& sums, float* to_re, float* to_im) noexcept {
    for (int l = 0; l < sums.lines; ++l) {
        F64 re = splat(0.0), im = splat(0.0);
        for (std::int32_t t = sums.first[l]; t < sums.first[l + 1]; ++t) {
            const F64 weight = splat(sums.weight[t]);
            re = re + weight * load(sums.re + sums.offset[t]);
            im = im + weight * load(sums.im + sums.offset[t]);
        }
        store(to_re + 16 * l, to_f32(re));
        store(to_im + 16 * l, to_f32(im));
    }
}

void multiply16(const float* from_re, const float* from_im, const float* spectrum_re,
                const float* spectrum_im, int length, float* to_re, float* to_im) noexcept {
    for (int k = 0; k < length; ++k) {
        const F32 a = load(from_re + 16 * k), b = load(from_im + 16 * k);
        const F32 c = splat(spectrum_re[k]), d = splat(spectrum_im[k]);
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

}  // namespace obscura::OBSCURA_ISA
