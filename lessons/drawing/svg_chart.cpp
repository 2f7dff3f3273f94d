#include "lessons/drawing/svg_chart.h"

#include <cmath>

#include <fmt/format.h>

#include "lessons/drawing/markup.h"

namespace obscura {
namespace {

std::string points_text(const std::vector<Vec2d>& points) {
    std::string text;
    for (const Vec2d p : points)
        text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", p.x, p.y);
    return text;
}

std::string_view anchor_name(Align align) {
    constexpr std::string_view names[] = {"start", "middle", "end"};
    return names[static_cast<int>(align)];
}

}  // namespace

SvgChart::SvgChart(int width, int height, std::string_view title)
    : markup_(fmt::format(
          "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" preserveAspectRatio=\"xMidYMid meet\">",
          width, height, html_text(title))) {}

void SvgChart::line(Vec2d from, Vec2d to, std::string_view look) {
    markup_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>",
                           from.x, from.y, to.x, to.y, look);
}

void SvgChart::text(Vec2d at, Align align, std::string_view look, std::string_view utf8) {
    markup_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" class=\"{}\">{}</text>", at.x,
                           at.y, anchor_name(align), look, html_text(utf8));
}

void SvgChart::box(const Box& b, std::string_view look, double corner) {
    markup_ +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"", b.x, b.y, b.w, b.h);
    if (corner > 0) markup_ += fmt::format(" rx=\"{}\"", corner);
    markup_ += fmt::format(" class=\"{}\"/>", look);
}

void SvgChart::polygon(const std::vector<Vec2d>& corners, std::string_view look) {
    markup_ += fmt::format("<polygon points=\"{}\" class=\"{}\"/>", points_text(corners), look);
}

void SvgChart::polyline(const std::vector<Vec2d>& points, std::string_view look) {
    markup_ += fmt::format("<polyline points=\"{}\" class=\"{}\"/>", points_text(points), look);
}

void SvgChart::disc(Vec2d centre, double radius, std::string_view look) {
    markup_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" class=\"{}\"/>", centre.x, centre.y,
                           radius, look);
}

void SvgChart::level(const Box& plot, double y, std::string_view meaning) {
    line({plot.x, y}, {plot.x + plot.w, y}, "grid");
    text({plot.x - 8, y + 4}, Align::right, "tick", meaning);
}

void SvgChart::number(const Box& plot, double x, std::string_view meaning) {
    text({x, plot.y + plot.h + 18}, Align::centre, "tick", meaning);
}

void SvgChart::base(const Box& plot) {
    line({plot.x, plot.y + plot.h}, {plot.x + plot.w, plot.y + plot.h}, "axis");
}

std::vector<double> round_ticks(double low, double high, int count) {
    const double wanted = (high - low) / count;
    double step = 1e-9;
    // 1, 2, 5, 10 ...: whole multiples of powers of ten are exact enough to print.
    for (int i = 0; step < wanted; ++i)
        step *= i % 3 == 1 ? 2.5 : 2.0;
    std::vector<double> ticks;
    for (double k = std::ceil(low / step); k * step <= high; ++k)
        ticks.push_back(k * step);
    return ticks;
}

std::string number_text(double value) {
    return fmt::format("{:.6g}", std::fabs(value) < 1e-12 ? 0.0 : value);
}

}  // namespace obscura
