#pragma once
// The range of disparity that a viewer fuses without strain. Scenes tell it in percent of the picture's width
// or in degrees of vergence; this room works in pixels.
//
// Shibata, Kim, Hoffman, Banks, "The zone of comfort: predicting visual discomfort with stereo displays",
// Journal of Vision 2011; Mendiburu, "3D Movie Making", 2009 (percent of width).

namespace obscura {

/// Pixels of the full picture, positive in front of the screen. The default holds everything.
struct ComfortZone {
    double nearest_px = 1e9;    ///< largest disparity
    double farthest_px = -1e9;  ///< smallest; <= nearest_px
};

}  // namespace obscura
