#pragma once
// Rows of 16-bit floats, as the paper keeps its maps (thesis, section 4.3.5). Rows are as those of
// grid_rows.h: a multiple of 16 numbers, aligned to 64 bytes.

#include <cstdint>

namespace obscura {

/// half_row: floats to IEEE binary16, to nearest, ties to even; beyond 65504 that.
///
/// float_row: and back, exact.
#define OBSCURA_HALF_ROWS                                                   \
    void half_row(const float* x, int count, std::uint16_t* half) noexcept; \
    void float_row(const std::uint16_t* half, int count, float* x) noexcept;
namespace ref {
OBSCURA_HALF_ROWS
}
namespace sse2 {
OBSCURA_HALF_ROWS
}
namespace avx2 {
OBSCURA_HALF_ROWS
}
namespace avx512bw {
OBSCURA_HALF_ROWS
}
#undef OBSCURA_HALF_ROWS

}  // namespace obscura
