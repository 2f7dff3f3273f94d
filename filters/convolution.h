#pragma once
// Linear convolution of planes: by fast Fourier transforms, or pixel by pixel where few pixels are not 0.
//
// Fourier: overlap-save (T. G. Stockham: High-speed convolution and correlation, 1966). The result is cut
// into tiles; each is the part of a cyclic convolution of 2^a x 2^b pixels that nothing wraps around into.
// Two tiles travel as real and imaginary part of one transform, since a real kernel keeps them apart. a and b
// are the cheapest, each for itself, so no plane is padded to the next power of two as a whole.

#include <cstdint>

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"

namespace obscura {

/// What is cheaper for a picture with `sources` pixels that are not 0. A fixed model of costs, no clock.
struct ConvolutionPlan {
    bool fft = false;
    double splat_ms = 0, fft_ms = 0;  ///< one plane, one thread
    std::int64_t fft_bytes = 0;       ///< what the FFT would hold, one plane, one thread, its result included
    int log2_x = 4, log2_y = 4;       ///< lengths of the transforms
    int tiles_x = 1, tiles_y = 1;     ///< of the result
};
/// Sizes from 1 up; the kernel at most 2^16 each way, else LimitError.
ConvolutionPlan plan_convolution(std::int64_t sources, int width, int height, int kernel_width,
                                 int kernel_height);

/// The full convolution, (width + kernel_width - 1) x (height + kernel_height - 1): nothing wraps around and
/// nothing is cut off, so the sum of the result is the product of the sums. Values must be finite. Errors are
/// about 2e-7 of the root of (sum of the source's squares * sum of the kernel's squares), and so may give
/// small values, either sign, where 0 is due; tiles that no source reaches are exactly 0.
Image<float> convolve_fft(ImageView<const float> source, ImageView<const float> kernel, const Exec& exec);
/// Channel by channel.
Image<Vec3f> convolve_fft(ImageView<const Vec3f> source, ImageView<const Vec3f> kernel, const Exec& exec);

/// The same by adding the kernel at every pixel of the source that is not 0, in row-major order.
Image<float> convolve_splats(ImageView<const float> source, ImageView<const float> kernel, const Exec& exec);
Image<Vec3f> convolve_splats(ImageView<const Vec3f> source, ImageView<const Vec3f> kernel, const Exec& exec);

}  // namespace obscura
