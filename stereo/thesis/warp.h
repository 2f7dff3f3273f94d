#pragma once
// An eye's picture by warping the middle one: the comparison, not what we show.
//
// Where only a picture and its disparity are known, this is what can be done (thesis 4.3.4, first paragraph):
// pixels move, nearer ones win, and what nobody saw is invented. Fehn, "Depth-Image-Based Rendering (DIBR),
// Compression, and Transmission for a New Approach on 3D-TV", SPIE 5291, 2004. Surfaces are
// moved as joined spans (row_spans.h), so that there are no cracks, only true disocclusions; these take the
// colour of the farther surface beside them, for what appears behind an outline belongs to the background.
// The layouts and reports that show it must say that it is warped.

#include <cstdint>

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "stereo/middle_view.h"

namespace obscura {

struct WarpedPicture {
    Image<Vec3f> picture;      ///< without margins
    Image<std::uint8_t> hole;  ///< 255 where the colour is invented, else 0
    std::int64_t holes = 0;    ///< pixels of them
};

struct WarpParams {
    double shift = 0.5;    ///< 0.5 left eye, -0.5 right eye; see EyeShift
    double join_px = 0.5;  ///< steps of disparity that do not tear a surface
};

/// `middle`: linear light, as large as the view, which is of full resolution; `disparity` moves it. Rows
/// without any pixel are black.
WarpedPicture warped(const Image<Vec3f>& middle, const MiddleView& view, const DisparityMap& disparity,
                     const WarpParams& params, const Exec& exec);

}  // namespace obscura
