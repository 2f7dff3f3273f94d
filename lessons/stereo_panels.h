#pragma once
// Panels of lessons 13 to 17: maps in colours, scales, rows and sizes of maps.

#include <string_view>
#include <vector>

#include "lessons/drawing/figure.h"
#include "stereo/disparity_colour.h"

namespace obscura {

/// A map in its colours.
void draw_map(Figure& f, Vec2d at, const DisparityMap& map, const DisparityColours& colours, int zoom = 1);
/// The colours' scale, 14 pixels high, its numbers below it; `at` is its upper left corner.
void draw_colours(Figure& f, Vec2d at, int width, const DisparityColours& colours, std::string_view unit);

/// Row y of a map.
std::vector<double> row_of(const DisparityMap& map, int y);
/// a - b.
DisparityMap difference(const DisparityMap& a, const DisparityMap& b);
/// Largest and root mean square of all values.
struct ErrorSize {
    double max_px = 0, rms_px = 0;
};
ErrorSize size_of(const DisparityMap& error);

}  // namespace obscura
