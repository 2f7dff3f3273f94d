#pragma once
// The hot loops of near fields, sixteen pixels of a row at a time. POD only.

#include <cstddef>
#include <cstdint>

#include "optics/field.h"

namespace obscura {

/// Weighted sums of table rows, one per line: terms first[l] to first[l + 1] of line l add weight x the
/// sixteen values that begin at re + offset (im + offset).
struct LineSums {
    int lines = 0;
    const std::int32_t* first = nullptr;
    const std::int64_t* offset = nullptr;
    const double* weight = nullptr;
    const double* re = nullptr;
    const double* im = nullptr;
};

/// Some of the elements of a transform become rows of the target, at column x: element first_element + k
/// element_step becomes row first_row + k row_step, k < count. All sixteen lanes are written.
struct RowStore {
    std::ptrdiff_t first_element = 0, element_step = 1;
    std::ptrdiff_t first_row = 0, row_step = 1;
    int count = 0;
    std::ptrdiff_t x = 0;
};

/// sum_lines16: line l goes to to_re[16 l] ... to_re[16 l + 15], rounded from double.
/// multiply16: to = from x spectrum, element by element; a coefficient of the spectrum serves sixteen lanes.
/// store_rows16: amplitudes, their squared magnitude, or both.
#define OBSCURA_NEAR_FIELD                                                                      \
    void sum_lines16(const LineSums& sums, float* to_re, float* to_im) noexcept;                \
    void multiply16(const float* from_re, const float* from_im, const float* spectrum_re,       \
                    const float* spectrum_im, int length, float* to_re, float* to_im) noexcept; \
    void store_rows16(const float* re, const float* im, const RowStore& rows,                   \
                      const FieldTarget& target) noexcept;
namespace ref {
OBSCURA_NEAR_FIELD
}
namespace sse2 {
OBSCURA_NEAR_FIELD
}
namespace avx2 {
OBSCURA_NEAR_FIELD
}
namespace avx512bw {
OBSCURA_NEAR_FIELD
}
#undef OBSCURA_NEAR_FIELD

}  // namespace obscura
