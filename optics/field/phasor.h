#pragma once
// Phasors e^(-2 pi i t) and the transforms of intervals, sixteen at a time. POD: kernels include this.
//
// Turns t are reduced in double (what is left of t after the nearest quarter turn is exact), then sine and
// cosine of at most an eighth of a turn are float polynomials: error below 1.5e-7 for |t| up to 2^30, where
// the double t itself has an error of 2^-23.

#include <cstdint>

namespace obscura {

/// Frequencies first + j step, j = 0 to count - 1, in cycles per unit of x.
struct FrequencyRamp {
    double first = 0, step = 0;
    int count = 0;
};

/// Functions of one coordinate, each a weighted sum of intervals: term k is the sum over r in [begin[k],
/// begin[k + 1]) of weight[r] on [x0[r], x1[r]). `begin` has count + 1 entries.
struct BoxTerms {
    const std::int32_t* begin = nullptr;
    const double* x0 = nullptr;
    const double* x1 = nullptr;
    const float* weight = nullptr;
    int count = 0;
};

/// phasors: re[j] + i im[j] = e^(-2 pi i turns[j]); exactly `count` values, arrays of any alignment.
/// phasor_row: the same for turns = (first + j step) x.
/// box_panel: re[16 k + l] + i im[16 k + l] = integral of term k times e^(-2 pi i u x) dx at the sixteen
/// frequencies u = first + (offset + l) step. An interval's transform is width * sinc(u width) * phasor of
/// its centre, never a difference of antiderivatives: nothing cancels, and u = 0 gives the exact width.
/// box_slope_panel: the derivatives of the same by u, times the ramp's step.
/// point_panel: each interval stands for a point at its middle: the sum of weight * phasor.
#define OBSCURA_PHASOR                                                                            \
    void phasors(const double* turns, int count, float* re, float* im) noexcept;                  \
    void phasor_row(const FrequencyRamp& ramp, double x, float* re, float* im) noexcept;          \
    void box_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re,       \
                   float* im) noexcept;                                                           \
    void box_slope_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re, \
                         float* im) noexcept;                                                     \
    void point_panel(const FrequencyRamp& ramp, int offset, const BoxTerms& terms, float* re,     \
                     float* im) noexcept;
namespace ref {
OBSCURA_PHASOR
}
namespace sse2 {
OBSCURA_PHASOR
}
namespace avx2 {
OBSCURA_PHASOR
}
namespace avx512bw {
OBSCURA_PHASOR
}
#undef OBSCURA_PHASOR

}  // namespace obscura
