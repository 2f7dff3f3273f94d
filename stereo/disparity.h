#pragma once
// Disparity maps: of the middle view from depth, and of both eyes' pictures, with what only one eye sees.
//
// Thesis 4.3.1 has the middle view's map alone. The eyes' own maps follow from it by drawing its rows as
// surfaces (row_spans.h), or exactly from each eye's depth, where the eyes were rasterized.

#include <cstdint>

#include "core/image.h"
#include "core/isa.h"
#include "stereo/middle_view.h"
#include "stereo/stereo_rig.h"

namespace obscura {

/// law.at(depth) per pixel, of pixel centres; depth in metres along the view axis, > 0, infinity where
/// nothing is. Eyes share the middle view's axis, so it serves their depth, too.
DisparityMap disparity_map(const Image<float>& depth_m, const DisparityLaw& law, const Exec& exec);

/// What the other eye sees of the surface in a pixel.
enum class Sight : std::uint8_t {
    both,     ///< it sees it, too
    hidden,   ///< something nearer is before it
    outside,  ///< it lies beyond its picture's side
    unknown,  ///< the map does not tell what is in this pixel
};

/// Of one eye's picture, without margins. Column x of the left eye is column x - disparity of the right
/// one's, column x of the right eye is column x + disparity of the left one's.
struct EyeDisparity {
    DisparityMap disparity;  ///< of the nearest surface; NaN where unknown
    DisparityMap original;   ///< before edits: orders surfaces; NaN where unknown
    Image<Sight> sight;
};

struct TwoWayDisparity {
    EyeDisparity left, right;  ///< left to right, right to left
};

/// Where eyes stand, in interaxial distances to the right of the map's own camera, times -1: a point at
/// column x of the map is at x + shift * disparity of theirs. A photograph taken by the left eye has {0, -1}.
struct EyeShift {
    double left = 0.5, right = -0.5;
};

struct TwoWayParams {
    EyeShift shift;
    double join_px = 0.5;    ///< steps of disparity that do not tear a surface
    double hidden_px = 0.5;  ///< nearer by this much hides; plus half the slope there, a pixel's rounding
};

/// Both eyes' maps from one map of full resolution: `disparity` (the view's own or an optimised one; NaN
/// where unknown) moves its surfaces, view.disparity orders them. What neither is seen nor bridged by a
/// surface stays unknown.
TwoWayDisparity two_way_disparity(const MiddleView& view, const DisparityMap& disparity,
                                  const TwoWayParams& params, const Exec& exec);

/// The same, exactly, from what each eye's own rasterizer saw: `disparity` and `original` of both are given,
/// `sight` is found by looking each surface up in the other eye's map.
TwoWayDisparity cross_checked(EyeDisparity left, EyeDisparity right, const TwoWayParams& params,
                              const Exec& exec);

/// As a picture: 255 where this eye alone sees the surface (hidden, outside), 128 where unknown, else 0.
Image<std::uint8_t> occlusion_mask(const EyeDisparity& eye);

}  // namespace obscura
