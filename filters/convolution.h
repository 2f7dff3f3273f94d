#pragma once
// Linear convolution of planes: by fast Fourier transforms, or pixel by pixel where few pixels are not 0.

#include <cstdint>

#include "core/image.h"
#include "core/isa.h"

namespace obscura {

/// What is cheaper for a picture with `sources` pixels that are not 0. A fixed model of costs, no clock.
struct ConvolutionPlan {
    bool fft = false;
    double splat_ms = 0, fft_ms = 0;  ///< one thread
    std::int64_t fft_bytes = 0;       ///< what the FFT would hold
};
ConvolutionPlan plan_convolution(std::int64_t sources, int width, int height, int kernel_width,
                                 int kernel_height);

/// The full convolution, (width + kernel_width - 1) x (height + kernel_height - 1): nothing wraps around and
/// nothing is cut off, so the sum of the result is the product of the sums.
Image<float> convolve_fft(ImageView<const float> source, ImageView<const float> kernel, const Exec& exec);

/// The same by adding the kernel at every pixel of the source that is not 0, in row-major order.
Image<float> convolve_splats(ImageView<const float> source, ImageView<const float> kernel, const Exec& exec);

}  // namespace obscura
