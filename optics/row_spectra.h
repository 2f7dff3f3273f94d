#pragma once
// Spectra of the rows of a mask, thirty-two rows in sixteen complex transforms. POD.

#include <cstddef>
#include <cstdint>

namespace obscura {

/// Up to 32 rows of a mask.
struct MaskRows {
    const float* first = nullptr;
    std::ptrdiff_t stride = 0;
    int width = 0, count = 0;
};

/// Where spectra go: element (group * height + row) * 16 + lane, frequency 16 group + lane.
struct SpectraTarget {
    float *re = nullptr, *im = nullptr;
    int height = 0, first_row = 0, count = 0;
};

/// load_rows16: texel x of row 2 l to re[16 x + l], of row 2 l + 1 to im[16 x + l]; zeros up to `length` and
/// where there are no more rows. split_rows16: from the transform of that (coefficients at position[]), the
/// spectra of the rows for frequencies 0 to M / 2 - 1; that of frequency 0, which is real, takes that of M /
/// 2 as imaginary part.
#define OBSCURA_ROW_SPECTRA                                                                             \
    void load_rows16(const MaskRows& rows, int length, float* re, float* im) noexcept;                  \
    void split_rows16(const float* re, const float* im, int log2_length, const std::uint32_t* position, \
                      const SpectraTarget& target) noexcept;
namespace ref {
OBSCURA_ROW_SPECTRA
}
namespace sse2 {
OBSCURA_ROW_SPECTRA
}
namespace avx2 {
OBSCURA_ROW_SPECTRA
}
namespace avx512bw {
OBSCURA_ROW_SPECTRA
}
#undef OBSCURA_ROW_SPECTRA

}  // namespace obscura
