#pragma once
// Fast Fourier transforms of sixteen sequences at once: lanes are independent transforms, so every
// instruction set does the same operations in the same order and gives the same bits.
//
// J. W. Cooley, J. W. Tukey: An algorithm for the machine calculation of complex Fourier series, 1965; radix
// 4 in place, decimation in frequency forward and in time backward, so that a convolution needs no
// reordering.

#include <cstdint>
#include <vector>

#include "core/isa.h"

namespace obscura {

/// What kernels read of a plan. POD.
struct FftTable {
    int log2_length = 0;
    /// Twiddles e^(-2 pi i j k / n) of a radix-4 pass of length n, n = length, length/4, ...: at
    /// fft_pass_offset(n) + 3 k + j - 1 for j = 1, 2, 3 and k < n/4.
    const float* re = nullptr;
    const float* im = nullptr;
};
/// Turns by eighths in passes of 8 and 16 are done without: (1 +- i) sqrt(1/2) costs less than a product.
inline constexpr float fft_eighth = 0.70710678118654752f;
/// The passes of lengths n/4, n/16, ... fill what is before.
constexpr int fft_pass_offset(int n) {
    return n / 4 - 1;
}

/// Twiddles of one length, rounded from double, and the order of the coefficients.
struct FftPlan {
    int log2_length = 0;
    std::vector<float> re, im;
    /// Coefficient k of a forward transform stands at position[k]; a permutation, its own inverse or not.
    std::vector<std::uint32_t> position;
    int length() const { return 1 << log2_length; }
    FftTable table() const { return {log2_length, re.data(), im.data()}; }
};

/// Lengths 2^0 to 2^16.
FftPlan fft_plan(int log2_length);

/// Element k of sequence l is re[16 k + l] + i im[16 k + l]; both arrays have 16 * length floats, aligned to
/// 64 bytes. In place, not scaled.
/// forward: X_j = sum over k of x_k e^(-2 pi i j k / length), X_j left at position[j].
/// backward: x_k = sum over j of X_j e^(+2 pi i j k / length), X_j read from position[j], x_k in order.
#define OBSCURA_FFT16                                                         \
    void fft16_forward(const FftTable& table, float* re, float* im) noexcept; \
    void fft16_backward(const FftTable& table, float* re, float* im) noexcept;
namespace ref {
OBSCURA_FFT16
}
namespace sse2 {
OBSCURA_FFT16
}
namespace avx2 {
OBSCURA_FFT16
}
namespace avx512bw {
OBSCURA_FFT16
}
#undef OBSCURA_FFT16

void fft16_forward(const FftPlan& plan, float* re, float* im, Isa isa);
void fft16_backward(const FftPlan& plan, float* re, float* im, Isa isa);

}  // namespace obscura
