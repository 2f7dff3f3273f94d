// Phasors and the transforms of intervals, sixteen frequencies at a time.

#include "optics/field/phasor.h"

#include "optics/field/phasor_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

template <class Interval>
OBSCURA_INLINE void fill_panel(const BoxTerms& terms, float* re, float* im, const Interval& interval) {
    for (int k = 0; k < terms.count; ++k) {
        Phasor16 sum = {splat(0.0f), splat(0.0f)};
        for (std::int32_t r = terms.begin[k]; r < terms.begin[k + 1]; ++r) {
            const Phasor16 box = interval(r);
            sum = {sum.re + box.re, sum.im + box.im};
        }
        store(re + lanes * k, sum.re);
        store(im + lanes * k, sum.im);
    }
}

}  // namespace

void phasors(const double* turns, int count, float* re, float* im) noexcept {
    for (int at = 0; at < count; at += lanes) {
        const int left = count - at;
        Phasor16 p;
        if (left >= lanes) {
            p = phasor(load(turns + at));
        } else {
            double padded[lanes] = {};
            for (int l = 0; l < left; ++l)
                padded[l] = turns[at + l];
            p = phasor(load(padded));
        }
        store_first(re + at, p.re, left);
        store_first(im + at, p.im, left);
    }
}

void phasor_row(const FrequencyRamp& ramp, double x, float* re, float* im) noexcept {
    for (int at = 0; at < ramp.count; at += lanes) {
        const Phasor16 p = phasor(ramp16(ramp, at) * splat(x));
        store_first(re + at, p.re, ramp.count - at);
        store_first(im + at, p.im, ramp.count - at);
    }
}

void box_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re, float* im) noexcept {
    const F64 u = ramp16(ramp, offset);
    fill_panel(terms, re, im,
               [&](std::int32_t r) { return box_transform(u, terms.x0[r], terms.x1[r], terms.weight[r]); });
}

void box_slope_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re,
                     float* im) noexcept {
    const F64 u = ramp16(ramp, offset);
    fill_panel(terms, re, im, [&](std::int32_t r) {
        return box_slope(u, ramp.step, terms.x0[r], terms.x1[r], terms.weight[r]);
    });
}

void point_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re,
                 float* im) noexcept {
    const F64 u = ramp16(ramp, offset);
    fill_panel(terms, re, im,
               [&](std::int32_t r) { return point_transform(u, terms.x0[r], terms.x1[r], terms.weight[r]); });
}

}  // namespace obscura::OBSCURA_ISA
