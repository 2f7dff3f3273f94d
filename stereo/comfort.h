#pragma once
// The range of disparity that a viewer fuses without strain. Zones are told in percent of the picture's width
// or in degrees of vergence; the rest of the room works in pixels.
//
// Shibata, Kim, Hoffman, Banks, "The zone of comfort: predicting visual discomfort with stereo displays",
// Journal of Vision 2011; Mendiburu, "3D Movie Making", 2009 (percent of width).

#include "stereo/stereo_rig.h"

namespace obscura {

/// Pixels of the full picture, positive in front of the screen. The default holds everything.
struct ComfortZone {
    double nearest_px = 1e9;    ///< largest disparity
    double farthest_px = -1e9;  ///< smallest; <= nearest_px
};

/// `nearest` and `farthest` in percent of the picture's width, positive in front of the screen.
ComfortZone comfort_of_percent(double nearest, double farthest, int picture_width);
/// `nearest` and `farthest` in degrees of vergence beyond the screen's own, positive in front of it.
ComfortZone comfort_of_degrees(double nearest, double farthest, int picture_width, const StereoRig& rig);
/// What both allow.
ComfortZone common(const ComfortZone& a, const ComfortZone& b);

}  // namespace obscura
