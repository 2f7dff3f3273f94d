#pragma once
// Sixteen columns at a time, one per lane, between a transform and a picture: products of all of them with
// one sequence, and rows of pixels. Element k of lane l is at 16 k + l. POD.

#include <cstddef>

#include "optics/field/field.h"

namespace obscura {

/// Some of the elements of a transform become rows of the target, at column x: element first_element + k
/// element_step becomes row first_row + k row_step, k < count. All sixteen lanes are written.
struct RowStore {
    std::ptrdiff_t first_element = 0, element_step = 1;
    std::ptrdiff_t first_row = 0, row_step = 1;
    int count = 0;
    std::ptrdiff_t x = 0;
};

/// multiply16: to = from x factor, element by element; a factor serves sixteen lanes. `to` may be `from`.
/// store_rows16: amplitudes, their squared magnitude, or both.
/// store_products16: the first `count` elements times their factors become rows of the target from row 0 on,
/// columns `column` to column + used - 1; 1 <= used <= 16.
#define OBSCURA_COLUMN_PRODUCTS                                                                             \
    void multiply16(const float* from_re, const float* from_im, const float* factor_re,                     \
                    const float* factor_im, int count, float* to_re, float* to_im) noexcept;                \
    void store_rows16(const float* re, const float* im, const RowStore& rows,                               \
                      const FieldTarget& target) noexcept;                                                  \
    void store_products16(const float* re, const float* im, const float* factor_re, const float* factor_im, \
                          int count, int column, int used, const FieldTarget& target) noexcept;
namespace ref {
OBSCURA_COLUMN_PRODUCTS
}
namespace sse2 {
OBSCURA_COLUMN_PRODUCTS
}
namespace avx2 {
OBSCURA_COLUMN_PRODUCTS
}
namespace avx512bw {
OBSCURA_COLUMN_PRODUCTS
}
#undef OBSCURA_COLUMN_PRODUCTS

}  // namespace obscura
