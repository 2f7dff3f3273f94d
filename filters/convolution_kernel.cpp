// The inner loops of convolution, sixteen numbers at a time.

#include "core/simd.h"
#include "filters/convolution_lanes.h"

namespace obscura::OBSCURA_ISA {

void transpose_blocks(const float* from, std::ptrdiff_t from_step, float* to, std::ptrdiff_t to_step,
                      int count) noexcept {
    for (int block = 0; block < count; ++block, from += from_step, to += to_step)
        transpose(from, to);
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
