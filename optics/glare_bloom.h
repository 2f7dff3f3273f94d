#pragma once
// The outskirts of a kernel at a fraction of the resolution.

#include "core/image.h"

namespace obscura {

/// A kernel in two: its core of side min(8 scale + 1, side), and the rest on a grid `scale` times as coarse;
/// they change over between 2 and 4 scale pixels from the centre. Coarse taps share their values linearly, so
/// sums and centres of gravity stay.
struct SplitKernel {
    Image<float> core, outskirts;
};
SplitKernel split_kernel(ImageView<const float> kernel, int scale);

/// A plane on the coarse grid: pixel (x, y) is shared linearly among the four coarse samples around
/// ((x + 0.5) / scale + 0.5, ...); coarse sample 1 lies at fine position (scale - 1) / 2.
Image<float> coarsened(ImageView<const float> fine, int scale);

/// The linear interpolation that is coarsened()'s transpose, divided by scale^2: value at fine pixel (x, y),
/// which may be negative, of a coarse plane whose sample (first, first) lies where sample 1 of coarsened()
/// does. Samples outside of the plane are 0. Summed over all pixels: the sum of the plane.
struct CoarsePlane {
    ImageView<const float> samples;
    int first = 1;
    int scale = 1;
    double at(int x, int y) const;
};

}  // namespace obscura
