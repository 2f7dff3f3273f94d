#pragma once
// Charts as SVG that stands inside of a page. Positions are units of the chart's own, y down; colours and
// pens are the page's, by the class that every shape has (its `look`): one chart fits light and dark paper.

#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"
#include "lessons/drawing/figure.h"

namespace obscura {

/// Where values lie along one axis: low at from, high at to.
struct ChartAxis {
    double from = 0, to = 1, low = 0, high = 1;
    double at(double value) const { return from + (to - from) * (value - low) / (high - low); }
};

class SvgChart {
  public:
    /// `title`: what is shown, for those who hear the page.
    SvgChart(int width, int height, std::string_view title);

    void line(Vec2d from, Vec2d to, std::string_view look);
    /// `at`: on the baseline, at the left end, middle or right end.
    void text(Vec2d at, Align align, std::string_view look, std::string_view utf8);
    /// `corner`: radius of its rounded corners.
    void box(const Box& box, std::string_view look, double corner = 0);
    void polygon(const std::vector<Vec2d>& corners, std::string_view look);
    void polyline(const std::vector<Vec2d>& points, std::string_view look);
    void disc(Vec2d centre, double radius, std::string_view look);

    /// A line across the plot at height y, with what it means on its left: looks "grid" and "tick".
    void level(const Box& plot, double y, std::string_view meaning);
    /// What position x means, below the plot's lower border: look "tick".
    void number(const Box& plot, double x, std::string_view meaning);
    /// The plot's lower border: look "axis".
    void base(const Box& plot);

    /// The whole element.
    std::string markup() const { return markup_ + "</svg>"; }

  private:
    std::string markup_;
};

/// Numbers about `count` apart on [low, high]: 1, 2 or 5 times a power of ten.
std::vector<double> round_ticks(double low, double high, int count);

/// Six digits at the most, and no "-0".
std::string number_text(double value);

}  // namespace obscura
