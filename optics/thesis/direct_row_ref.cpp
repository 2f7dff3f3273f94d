// The direct sum, one quad at one frequency at a time.

#include "optics/field/compensated_sum.h"
#include "optics/field/phasor_scalar.h"
#include "optics/thesis/direct_row.h"

namespace obscura::ref {

void direct_row(const FrequencyRamp& ramp, const BoxTerms& x, const float* y_re, const float* y_im, float* re,
                float* im) noexcept {
    for (int j = 0; j < ramp.count; ++j) {
        const double u = ramp.first + j * ramp.step;
        Phasor sum, lost;
        for (int k = 0; k < x.count; ++k) {
            const Phasor box = box_transform(u, x.x0[k], x.x1[k], x.weight[k]);
            const float b_re = y_re[16 * k], b_im = y_im[16 * k];
            add_compensated(box.re * b_re - box.im * b_im, sum.re, lost.re);
            add_compensated(box.re * b_im + box.im * b_re, sum.im, lost.im);
        }
        re[j] = sum.re;
        im[j] = sum.im;
    }
}

}  // namespace obscura::ref
