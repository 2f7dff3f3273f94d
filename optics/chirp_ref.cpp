// One lane at a time: what chirp_kernel.cpp does sixteen at a time.

#include "optics/chirp.h"

namespace obscura::ref {

void scale_rows16(const float* factor_re, const float* factor_im, int count, float* re, float* im) noexcept {
    for (int k = 0; k < count; ++k) {
        for (int i = 16 * k; i < 16 * k + 16; ++i) {
            const float a = re[i], b = im[i];
            re[i] = a * factor_re[k] - b * factor_im[k];
            im[i] = a * factor_im[k] + b * factor_re[k];
        }
    }
}

void store_rows16(const float* re, const float* im, const float* factor_re, const float* factor_im, int count,
                  int column, int used, const FieldTarget& target) noexcept {
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
