#pragma once
// Panels of lessons 9 to 12 and 18: patterns on a scale of colours, masks.

#include <string_view>

#include "core/image.h"
#include "lessons/drawing/figure.h"

namespace obscura {

/// Colours of powers: equal steps per decade, `peak` the brightest, peak * 10^-decades and less the darkest.
struct LogScale {
    double peak = 1, decades = 6;
    Rgb8 color(double power) const;
};

/// One pixel per value, its upper left corner at `origin` (whole pixels), framed.
void draw_power(Figure& f, Vec2d origin, ImageView<const float> power, const LogScale& scale);

/// The scale itself as a bar of 14 pixels' height, named at both ends; `at` is its left end.
void draw_scale(Figure& f, Vec2d at, double width, std::string_view low, std::string_view high);

/// Texels from paper (0) to `color` (1), each `side` pixels wide (a whole number); framed.
void draw_mask(Figure& f, Vec2d origin, int side, ImageView<const float> mask, Rgb8 color);

}  // namespace obscura
