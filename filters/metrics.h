#pragma once
// How far apart two pictures are.

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/image_io.h"
#include "core/isa.h"
#include "core/pixel.h"

namespace obscura {

/// A picture as one float image per channel, in the units of its file (codes 0..255 or 0..65535, or linear).
using Planes = std::vector<Image<float>>;

/// Red, green, blue, and alpha on demand.
Planes split_channels(ImageView<const Rgba8> image, bool with_alpha);
Planes split_channels(ImageView<const Rgba16> image, bool with_alpha);
/// One or three channels.
Planes split_channels(const FloatImage& image);

/// The reach of the finite values, at least 1e-30: the peak that PSNR and SSIM refer to for linear pictures.
double value_range(const Planes& planes);

struct CompareParams {
    double peak = 255.0;     ///< difference between black and white
    double threshold = 0.0;  ///< pixels count as different beyond this, in the largest channel difference
};

/// All differences are absolute, per channel, in the units of the pictures. Values that are not finite (the
/// sky in a picture of depths): equal infinities and two NaN do not differ; any other pair with a NaN or an
/// infinity differs by infinity, which is beyond every threshold. Mean and PSNR are taken over the pairs of
/// two finite values, SSIM over the windows that hold only such pairs; NaN never comes out.
struct ImageDifference {
    double max_error = 0;            ///< infinity where one value of a pair alone is not finite
    double mean_error = 0;           ///< over the finite pairs of all channels; 0 when there is none
    double psnr_db = 0;              ///< 10 log10(peak^2 / mean square error); infinity when these are equal
    double ssim = 1;                 ///< see structural_similarity()
    std::int64_t not_finite = 0;     ///< pairs with a value that is not finite, over all channels
    std::int64_t pixels_over = 0;    ///< pixels beyond the threshold
    int max_x = 0, max_y = 0;        ///< the first pixel, row by row, with the largest difference
    int first_x = -1, first_y = -1;  ///< the first pixel beyond the threshold, or -1
};

/// Both pictures have the same size and number of channels. The same result for any number of threads.
ImageDifference compare_images(const Planes& a, const Planes& b, const CompareParams& params,
                               const Exec& exec);

/// Mean SSIM index in [-1, 1] of one channel: Z. Wang, A. Bovik, H. Sheikh, E. Simoncelli, "Image quality
/// assessment: from error visibility to structural similarity", IEEE TIP 13(4), 2004, eq. 13 with an 11 x 11
/// Gaussian window of sigma 1.5, K1 = 0.01, K2 = 0.03, over the windows that lie inside the picture. A
/// picture narrower than the window gets the largest odd window that fits. For colour we average the
/// channels, where the paper compares luminance only. Windows with a value that is not finite do not count;
/// when none is left, 1 for pictures of equal values (see ImageDifference) and 0 otherwise.
double structural_similarity(const Image<float>& a, const Image<float>& b, double peak, const Exec& exec);

/// The largest channel difference of each pixel in false colour: black 0, through blue, red and yellow to
/// white at full_scale and beyond; full_scale > 0.
Image<Rgb8> difference_picture(const Planes& a, const Planes& b, double full_scale);

}  // namespace obscura
