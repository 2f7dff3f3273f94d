#pragma once
// Weighted sums of rows of a table, sixteen pixels at a time. POD only.

#include <cstdint>

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

/// sum_lines16: line l goes to to_re[16 l] ... to_re[16 l + 15], rounded from double.
#define OBSCURA_LINE_SUMS void sum_lines16(const LineSums& sums, float* to_re, float* to_im) noexcept;
namespace ref {
OBSCURA_LINE_SUMS
}
namespace sse2 {
OBSCURA_LINE_SUMS
}
namespace avx2 {
OBSCURA_LINE_SUMS
}
namespace avx512bw {
OBSCURA_LINE_SUMS
}
#undef OBSCURA_LINE_SUMS

}  // namespace obscura
