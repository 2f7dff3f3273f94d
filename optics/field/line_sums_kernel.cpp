// Weighted sums of rows of a table. See line_sums_ref.cpp.

#include "optics/field/line_sums.h"

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

}  // namespace obscura::OBSCURA_ISA
