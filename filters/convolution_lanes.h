#pragma once
// The inner loops of convolution. Pointers to blocks are aligned to 64 bytes.

#include <cstddef>

namespace obscura {

/// transpose_blocks: `count` blocks of 16 x 16 floats, each contiguous and row-major, `from_step` and
/// `to_step` floats apart. multiply_spectra: z[i] = z[i] * k[i], complex, i < count; count is a multiple
/// of 16. add_scaled: out[i] = out[i] + scale * row[i], i < count; no alignment.
#define OBSCURA_CONVOLUTION                                                                               \
    void transpose_blocks(const float* from, std::ptrdiff_t from_step, float* to, std::ptrdiff_t to_step, \
                          int count) noexcept;                                                            \
    void multiply_spectra(float* re, float* im, const float* kernel_re, const float* kernel_im,           \
                          int count) noexcept;                                                            \
    void add_scaled(float* out, const float* row, float scale, int count) noexcept;
namespace ref {
OBSCURA_CONVOLUTION
}
namespace sse2 {
OBSCURA_CONVOLUTION
}
namespace avx2 {
OBSCURA_CONVOLUTION
}
namespace avx512bw {
OBSCURA_CONVOLUTION
}
#undef OBSCURA_CONVOLUTION

}  // namespace obscura
