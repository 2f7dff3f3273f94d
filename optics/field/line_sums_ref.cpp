// Weighted sums of rows of a table, one lane at a time.

#include "optics/field/line_sums.h"

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

}  // namespace obscura::ref
