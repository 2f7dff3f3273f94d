#pragma once
// Disparity as colour: the screen is a light neutral grey, what is in front of it warm, what is behind cool.
//
// K. Moreland, "Diverging Color Maps for Scientific Visualization", ISVC 2009: from blue to
// red over white in polar coordinates of CIELAB, with the hue turned a little near white, so that equal steps
// look equally large and the middle has no visible crease. Both sides have the same scale here: as deep a red
// is as far in front as as deep a blue is behind.

#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "core/pixel.h"
#include "stereo/middle_view.h"

namespace obscura {

/// Pixels of disparity. What is past the range has the colour of its end; what is past the comfort zone is
/// striped, rising to the right if too near, falling if too far.
struct DisparityColours {
    double far_px = -30, near_px = 30;                    ///< far_px < near_px
    double comfort_far_px = -1e9, comfort_near_px = 1e9;  ///< defaults: all is comfortable
};

/// A range that holds every finite value, rounded outwards to whole pixels; at least [-1, 1].
DisparityColours colours_for(const DisparityMap& map);

/// Without stripes. NaN is nearly black: nothing is known.
Rgb8 disparity_colour(double disparity_px, const DisparityColours& colours);

Image<Rgb8> disparity_picture(const DisparityMap& map, const DisparityColours& colours, const Exec& exec);

/// Where a number belongs under the strip.
struct ScaleTick {
    double disparity_px = 0;
    double x = 0;  ///< pixels from the strip's left border
};
struct DisparityScale {
    Image<Rgb8> strip;  ///< far on the left, near on the right, stripes as in pictures, ticks drawn
    std::vector<ScaleTick> ticks;  ///< 1, 2 or 5 times a power of ten apart, ascending, 0 among them
};
/// width >= 16, height >= 4.
DisparityScale disparity_scale(int width, int height, const DisparityColours& colours);

}  // namespace obscura
