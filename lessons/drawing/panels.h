#pragma once
// Panels of a figure that know nothing of what they show: pictures, axes and their numbers, curves.

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "lessons/drawing/figure.h"

namespace obscura {

/// log10(x), x > 0; the same bits everywhere.
double decades_of(double x);
/// "0.01" to "1000", else "1e-5".
std::string power_of_ten_text(int exponent);

/// Every pixel zoom x zoom of the figure's, its upper left corner at `at` (whole pixels); framed.
void draw_picture(Figure& f, Vec2d at, const Image<Rgb8>& picture, int zoom = 1);

/// Axes and lines at the powers of ten of a plot whose y (and, with `x_too`, x) are logarithms to base 10.
void decade_axes(Figure& f, const Plot& plot, bool x_too, std::string_view x_name, std::string_view y_name);

/// log10 of values at equal steps from plot.x0 to plot.x1, drawn no lower than plot.y0.
void decade_curve(Figure& f, const Plot& plot, const std::vector<double>& values, const Pen& pen);

/// Lines across the plot, with their numbers left of it.
void level_lines(Figure& f, const Plot& plot, std::initializer_list<int> levels);

/// Numbers below the horizontal axis.
void axis_numbers(Figure& f, const Plot& plot, std::initializer_list<double> numbers, int decimals);

/// Values at pixel centres 0.5, 1.5 ... of plot.x; a step between neighbours of more than `tear` is not
/// drawn.
void row_curve(Figure& f, const Plot& plot, const std::vector<double>& values, const Pen& pen,
               double tear = 1e9);

}  // namespace obscura
