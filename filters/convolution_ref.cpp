// The inner loops of convolution, one number at a time.

#include "filters/convolution_lanes.h"

namespace obscura::ref {

void transpose_blocks(const float* from, std::ptrdiff_t from_step, float* to, std::ptrdiff_t to_step,
                      int count) noexcept {
    for (int block = 0; block < count; ++block) {
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x)
                to[block * to_step + 16 * x + y] = from[block * from_step + 16 * y + x];
        }
    }
}

void multiply_spectra(float* re, float* im, const float* kernel_re, const float* kernel_im,
                      int count) noexcept {
    for (int i = 0; i < count; ++i) {
        const float a = re[i], b = im[i];
        re[i] = a * kernel_re[i] - b * kernel_im[i];
        im[i] = a * kernel_im[i] + b * kernel_re[i];
    }
}

void add_scaled(float* out, const float* row, float scale, int count) noexcept {
    for (int i = 0; i < count; ++i)
        out[i] = out[i] + scale * row[i];
}

}  // namespace obscura::ref
