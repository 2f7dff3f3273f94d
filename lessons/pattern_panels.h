#pragma once
// Panels of lessons 9 to 12: patterns on a scale of colours, masks, axes in powers of ten.

#include <initializer_list>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "lessons/drawing/figure.h"

namespace obscura {

/// log10(x), x > 0; the same bits everywhere.
double decades_of(double x);

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

/// Axes and lines at the powers of ten of a plot whose y (and, with `x_too`, x) are logarithms to base 10.
void decade_axes(Figure& f, const Plot& plot, bool x_too, std::string_view x_name, std::string_view y_name);

/// log10 of values at equal steps from plot.x0 to plot.x1, drawn no lower than plot.y0.
void decade_curve(Figure& f, const Plot& plot, const std::vector<double>& values, const Pen& pen);

/// Lines across the plot, with their numbers left of it.
void level_lines(Figure& f, const Plot& plot, std::initializer_list<int> levels);

/// Numbers below the horizontal axis.
void axis_numbers(Figure& f, const Plot& plot, std::initializer_list<double> numbers, int decimals);

}  // namespace obscura
