// One lane at a time: what column_products_kernel.cpp does sixteen at a time.

#include "optics/column_products.h"

namespace obscura::ref {

void multiply16(const float* from_re, const float* from_im, const float* factor_re, const float* factor_im,
                int count, float* to_re, float* to_im) noexcept {
    for (int k = 0; k < count; ++k) {
        for (int i = 16 * k; i < 16 * k + 16; ++i) {
            const float re = from_re[i] * factor_re[k] - from_im[i] * factor_im[k];
            const float im = from_re[i] * factor_im[k] + from_im[i] * factor_re[k];
            to_re[i] = re;
            to_im[i] = im;
        }
    }
}

void store_rows16(const float* re, const float* im, const RowStore& rows,
                  const FieldTarget& target) noexcept {
    for (int k = 0; k < rows.count; ++k) {
        const std::ptrdiff_t from = 16 * (rows.first_element + k * rows.element_step);
        const std::ptrdiff_t row = (rows.first_row + k * rows.row_step) * target.stride + rows.x;
        for (int lane = 0; lane < 16; ++lane) {
            const float a = re[from + lane], b = im[from + lane];
            if (target.re) target.re[row + lane] = a;
            if (target.im) target.im[row + lane] = b;
            if (target.power) target.power[row + lane] = a * a + b * b;
        }
    }
}

void store_products16(const float* re, const float* im, const float* factor_re, const float* factor_im,
                      int count, int column, int used, const FieldTarget& target) noexcept {
    for (int k = 0; k < count; ++k) {
        for (int l = 0; l < used; ++l) {
            const float a = re[16 * k + l], b = im[16 * k + l];
            const float c = a * factor_re[k] - b * factor_im[k], d = a * factor_im[k] + b * factor_re[k];
            const std::ptrdiff_t at = k * target.stride + column + l;
            if (target.power != nullptr) target.power[at] = c * c + d * d;
            if (target.re != nullptr) {
                target.re[at] = c;
                target.im[at] = d;
            }
        }
    }
}

}  // namespace obscura::ref
