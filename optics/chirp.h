#pragma once
// Products of sixteen sequences with one, and rows of sixteen columns into a grid. POD.

#include "optics/field.h"

namespace obscura {

/// scale_rows16: re[16 k + l] + i im[16 k + l] times factor_re[k] + i factor_im[k], k = 0 to count - 1, in
/// place. store_rows16: row k of `target`, columns `column` to column + used - 1, from element 16 k + l
/// times the factor of k; 1 <= used <= 16.
#define OBSCURA_CHIRP                                                                                   \
    void scale_rows16(const float* factor_re, const float* factor_im, int count, float* re,             \
                      float* im) noexcept;                                                              \
    void store_rows16(const float* re, const float* im, const float* factor_re, const float* factor_im, \
                      int count, int column, int used, const FieldTarget& target) noexcept;
namespace ref {
OBSCURA_CHIRP
}
namespace sse2 {
OBSCURA_CHIRP
}
namespace avx2 {
OBSCURA_CHIRP
}
namespace avx512bw {
OBSCURA_CHIRP
}
#undef OBSCURA_CHIRP

}  // namespace obscura
