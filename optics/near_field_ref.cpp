// Sums of edges, products of spectra, rows of pixels: one lane at a time.

#include "optics/near_field_kernels.h"

namespace obscura::ref {

void sum_lines16(const LineSums& sums, float* to_re, float* to_im) noexcept {
    for (int l = 0; l < sums.lines; ++l) {
        for (int lane = 0; lane < 16; ++lane) {
            double re = 0, im = 0;
            for (std::int32_t t = sums.first[l]; t < sums.first[l + 1]; ++t) {
                re += sums.weight[t] * sums.re[sums.offset[t] + lane];
                im += sums.weight[t] * sums.im[sums.offset[t] + lane];
            }
            to_re[16 * l + lane] = static_cast<float>(re);
            to_im[16 * l + lane] = static_cast<float>(im);
        }
    }
}

void multiply16(const float* from_re, const float* from_im, const float* spectrum_re,
                const float* spectrum_im, int length, float* to_re, float* to_im) noexcept {
    for (int k = 0; k < length; ++k) {
        for (int i = 16 * k; i < 16 * k + 16; ++i) {
            const float re = from_re[i] * spectrum_re[k] - from_im[i] * spectrum_im[k];
            const float im = from_re[i] * spectrum_im[k] + from_im[i] * spectrum_re[k];
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

}  // namespace obscura::ref
