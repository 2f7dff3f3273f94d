// Phasors and the transforms of intervals, one at a time.

#include "optics/field/phasor.h"
#include "optics/field/phasor_scalar.h"

namespace obscura::ref {
namespace {

/// Every term at sixteen frequencies: the sum of interval(u, r) over its intervals r.
template <class Interval>
void fill_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re, float* im,
                const Interval& interval) {
    for (int k = 0; k < terms.count; ++k) {
        for (int l = 0; l < 16; ++l) {
            const double u = ramp.first + (offset + l) * ramp.step;
            Phasor sum;
            for (std::int32_t r = terms.begin[k]; r < terms.begin[k + 1]; ++r) {
                const Phasor box = interval(u, r);
                sum = {sum.re + box.re, sum.im + box.im};
            }
            re[16 * k + l] = sum.re;
            im[16 * k + l] = sum.im;
        }
    }
}

}  // namespace

void phasors(const double* turns, int count, float* re, float* im) noexcept {
    for (int j = 0; j < count; ++j) {
        const Phasor p = phasor(turns[j]);
        re[j] = p.re;
        im[j] = p.im;
    }
}

void phasor_row(const FrequencyRamp& ramp, double x, float* re, float* im) noexcept {
    for (int j = 0; j < ramp.count; ++j) {
        const Phasor p = phasor((ramp.first + j * ramp.step) * x);
        re[j] = p.re;
        im[j] = p.im;
    }
}

void box_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re, float* im) noexcept {
    fill_panel(ramp, offset, terms, re, im, [&](double u, std::int32_t r) {
        return box_transform(u, terms.x0[r], terms.x1[r], terms.weight[r]);
    });
}

void box_slope_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re,
                     float* im) noexcept {
    fill_panel(ramp, offset, terms, re, im, [&](double u, std::int32_t r) {
        return box_slope(u, ramp.step, terms.x0[r], terms.x1[r], terms.weight[r]);
    });
}

void point_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re,
                 float* im) noexcept {
    fill_panel(ramp, offset, terms, re, im, [&](double u, std::int32_t r) {
        return point_transform(u, terms.x0[r], terms.x1[r], terms.weight[r]);
    });
}

}  // namespace obscura::ref
