#pragma once
// From the spectra of sixteen columns to the pixels that repeat them. POD.
//
// On a natural grid the sums over texels repeat with the period M, and those of a real mask are mirrored
// within it: S(M - j, M - k) is the conjugate of S(j, k). So a column j between 0 and M / 2 serves every
// column of the grid that is congruent to j or -j; only the factors of a texel's own transform differ.

#include <cstdint>

#include "optics/field/field.h"

namespace obscura {

/// Rows of a grid: row r shows sample (first + r) mod M, times a factor.
struct SpectrumRows {
    int log2_period = 0, count = 0;
    std::int64_t first = 0;
    const std::uint32_t* position = nullptr;  ///< where the transform has left sample k
    const float *re = nullptr, *im = nullptr, *power = nullptr;
};

/// Sixteen neighbouring columns of a grid, and what belongs to each lane. Lane l is column + l, or, mirrored,
/// column + 15 - l. Lanes with keep[l] = 0 are left as they are (nullptr: all are written).
struct ColumnStrip {
    int column = 0;
    bool mirrored = false;
    const float *re = nullptr, *im = nullptr, *power = nullptr;
    const std::uint8_t* keep = nullptr;
};

/// Spectra of sixteen columns (see filters/fft.h for their layout) and the strips that show them; of two
/// times sixteen, when two groups with real sums were transformed as the real and the imaginary part of one.
struct SpectrumBlock {
    const float *re = nullptr, *im = nullptr;
    const ColumnStrip* strips = nullptr;
    int strip_count = 0;
    const ColumnStrip* partner_strips = nullptr;  ///< of the imaginary part's group
    int partner_count = 0;
};

/// store_columns16: blocks of complex sums. A mirrored strip shows the conjugate of the opposite sample.
/// store_real_columns16: blocks of pairs of groups. Columns need no conjugate: their factors take care of
/// what is mirrored. Neighbouring blocks in one call write neighbouring memory.
#define OBSCURA_COLUMN_STORE                                                                    \
    void store_columns16(const SpectrumBlock* blocks, int count, const SpectrumRows& rows,      \
                         const FieldTarget& target) noexcept;                                   \
    void store_real_columns16(const SpectrumBlock* blocks, int count, const SpectrumRows& rows, \
                              const FieldTarget& target) noexcept;
namespace ref {
OBSCURA_COLUMN_STORE
}
namespace sse2 {
OBSCURA_COLUMN_STORE
}
namespace avx2 {
OBSCURA_COLUMN_STORE
}
namespace avx512bw {
OBSCURA_COLUMN_STORE
}
#undef OBSCURA_COLUMN_STORE

}  // namespace obscura
