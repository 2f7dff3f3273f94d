#pragma once
// The direct sum's inner loop. POD: kernels include this.

#include "optics/field/phasor.h"

namespace obscura {

/// One row of frequencies: re[j] + i im[j] = sum over k of (transform of x-term k at ramp's frequency j)
/// times (y_re[16 k] + i y_im[16 k]). Terms of one interval each.
#define OBSCURA_DIRECT_ROW                                                                              \
    void direct_row(const FrequencyRamp& ramp, const BoxTerms& x, const float* y_re, const float* y_im, \
                    float* re, float* im) noexcept;
namespace ref {
OBSCURA_DIRECT_ROW
}
namespace sse2 {
OBSCURA_DIRECT_ROW
}
namespace avx2 {
OBSCURA_DIRECT_ROW
}
namespace avx512bw {
OBSCURA_DIRECT_ROW
}
#undef OBSCURA_DIRECT_ROW

}  // namespace obscura
