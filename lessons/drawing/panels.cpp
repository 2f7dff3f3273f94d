#include "lessons/drawing/panels.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/num.h"

namespace obscura {

double decades_of(double x) {
    return num::log2(x) * 0.30102999566398120;
}

std::string power_of_ten_text(int exponent) {
    constexpr const char* small[] = {"0.01", "0.1", "1", "10", "100", "1000"};
    return exponent >= -2 && exponent <= 3 ? small[exponent + 2] : fmt::format("1e{}", exponent);
}

void draw_picture(Figure& f, Vec2d at, const Image<Rgb8>& picture, int zoom) {
    Image<Rgb8> large(picture.width * zoom, picture.height * zoom);
    for (int y = 0; y < large.height; ++y) {
        for (int x = 0; x < large.width; ++x)
            large(x, y) = picture(x / zoom, y / zoom);
    }
    f.image(static_cast<int>(at.x), static_cast<int>(at.y), large, 1);
    f.frame({at.x, at.y, static_cast<double>(large.width), static_cast<double>(large.height)},
            {ink::soft, 1});
}

void decade_axes(Figure& f, const Plot& plot, bool x_too, std::string_view x_name, std::string_view y_name) {
    f.axes(plot, "", y_name);
    for (double e = std::ceil(plot.y0); e <= plot.y1; ++e) {
        f.line(plot.at(plot.x0, e), plot.at(plot.x1, e), {ink::grid, 1});
        f.text(plot.at(plot.x0, e) + Vec2d{-8, 4}, power_of_ten_text(static_cast<int>(e)),
               {8.5, ink::soft, Align::right});
    }
    for (double e = std::ceil(plot.x0); x_too && e <= plot.x1; ++e) {
        f.line(plot.at(e, plot.y0), plot.at(e, plot.y1), {ink::grid, 1});
        f.text(plot.at(e, plot.y0) + Vec2d{0, 18}, power_of_ten_text(static_cast<int>(e)), lettering::tick);
    }
    f.text(plot.at(plot.x1, plot.y0) + Vec2d{10, 38}, x_name, {9, ink::soft, Align::right});
}

void decade_curve(Figure& f, const Plot& plot, const std::vector<double>& values, const Pen& pen) {
    const double step = (plot.x1 - plot.x0) / (static_cast<double>(values.size()) - 1);
    std::vector<Vec2d> line;
    for (const double value : values) {
        const double y = value > 0 ? std::max(decades_of(value), plot.y0) : plot.y0;
        line.push_back(plot.at(plot.x0 + static_cast<double>(line.size()) * step, y));
    }
    f.polyline(line, pen);
}

void level_lines(Figure& f, const Plot& plot, std::initializer_list<int> levels) {
    for (const int y : levels) {
        f.line(plot.at(plot.x0, y), plot.at(plot.x1, y), {ink::grid, 1});
        f.text(plot.at(plot.x0, y) + Vec2d{-8, 4}, fmt::format("{}", y), {8.5, ink::soft, Align::right});
    }
}

void axis_numbers(Figure& f, const Plot& plot, std::initializer_list<double> numbers, int decimals) {
    for (const double x : numbers)
        f.text(plot.at(x, plot.y0) + Vec2d{0, 18}, fmt::format("{:.{}f}", x, decimals), lettering::tick);
}

void row_curve(Figure& f, const Plot& plot, const std::vector<double>& values, const Pen& pen, double tear) {
    std::vector<Vec2d> line;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0 && std::fabs(values[i] - values[i - 1]) > tear) {
            if (line.size() > 1) f.polyline(line, pen);
            line.clear();
        }
        line.push_back(plot.at(static_cast<double>(i) + 0.5, std::clamp(values[i], plot.y0, plot.y1)));
    }
    if (line.size() > 1) f.polyline(line, pen);
}

}  // namespace obscura
