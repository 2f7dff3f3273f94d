// The direct sum, sixteen frequencies of a row at a time.

#include "optics/thesis/direct_row.h"

#include "optics/field/compensated_sum.h"
#include "optics/field/phasor_lanes.h"

namespace obscura::OBSCURA_ISA {

void direct_row(const FrequencyRamp& ramp, const BoxTerms& x, const float* y_re, const float* y_im, float* re,
                float* im) noexcept {
    for (int at = 0; at < ramp.count; at += lanes) {
        const F64 u = ramp16(ramp, at);
        Phasor16 sum = {splat(0.0f), splat(0.0f)}, lost = sum;
        for (int k = 0; k < x.count; ++k) {
            const Phasor16 box = box_transform(u, x.x0[k], x.x1[k], x.weight[k]);
            const F32 b_re = splat(y_re[lanes * k]), b_im = splat(y_im[lanes * k]);
            add_compensated(box.re * b_re - box.im * b_im, sum.re, lost.re);
            add_compensated(box.re * b_im + box.im * b_re, sum.im, lost.im);
        }
        store_first(re + at, sum.re, ramp.count - at);
        store_first(im + at, sum.im, ramp.count - at);
    }
}

}  // namespace obscura::OBSCURA_ISA
