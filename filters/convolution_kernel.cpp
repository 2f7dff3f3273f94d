// The inner loops of convolution, sixteen numbers at a time.

#include "core/simd.h"
#include "filters/convolution_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

using Float4 = float __attribute__((vector_size(16)));

OBSCURA_INLINE Float4 load4(const float* p) {
    return *reinterpret_cast<const Float4*>(p);
}

/// 4 x 4 numbers of a block of 16 x 16.
OBSCURA_INLINE void transpose4(const float* from, float* to) {
    const Float4 a = load4(from), b = load4(from + 16), c = load4(from + 32), d = load4(from + 48);
    const Float4 ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const Float4 ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Float4 cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const Float4 cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    auto* const rows = reinterpret_cast<Float4*>(to);
    rows[0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
    rows[4] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
    rows[8] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
    rows[12] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

}  // namespace

void transpose_blocks(const float* from, std::ptrdiff_t from_step, float* to, std::ptrdiff_t to_step,
                      int count) noexcept {
    for (int block = 0; block < count; ++block, from += from_step, to += to_step) {
        for (int x = 0; x < 16; x += 4) {
            for (int y = 0; y < 16; y += 4)
                transpose4(from + 16 * y + x, to + 16 * x + y);
        }
    }
}

void multiply_spectra(float* re, float* im, const float* kernel_re, const float* kernel_im,
                      int count) noexcept {
    for (int i = 0; i < count; i += lanes) {
        const F32 a = load(re + i), b = load(im + i), c = load(kernel_re + i), s = load(kernel_im + i);
        store(re + i, a * c - b * s);
        store(im + i, a * s + b * c);
    }
}

void add_scaled(float* out, const float* row, float scale, int count) noexcept {
    const F32 factor = splat(scale);
    int i = 0;
    for (; i + lanes <= count; i += lanes)
        store(out + i, load(out + i) + factor * load(row + i));
    for (; i < count; ++i)
        out[i] = out[i] + scale * row[i];
}

}  // namespace obscura::OBSCURA_ISA
