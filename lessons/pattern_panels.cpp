#include "lessons/pattern_panels.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/num.h"

namespace obscura {

double decades_of(double x) {
    return num::log2(x) * 0.30102999566398120;
}

Rgb8 LogScale::color(double power) const {
    // 64 shades: more cannot be told apart, and fewer make smaller files.
    constexpr double shades = 64;
    if (power <= 0) return heat(0);
    const double t = std::clamp(1 + decades_of(power / peak) / decades, 0.0, 1.0);
    return heat(std::min(std::floor(t * shades), shades - 1) / (shades - 1));
}

void draw_power(Figure& f, Vec2d origin, ImageView<const float> power, const LogScale& scale) {
    Image<Rgb8> colors(power.width, power.height);
    for (int y = 0; y < power.height; ++y) {
        for (int x = 0; x < power.width; ++x)
            colors(x, y) = scale.color(static_cast<double>(power(x, y)));
    }
    f.image(static_cast<int>(origin.x), static_cast<int>(origin.y), colors, 1);
    f.frame({origin.x, origin.y, static_cast<double>(power.width), static_cast<double>(power.height)},
            {ink::soft, 1});
}

void draw_scale(Figure& f, Vec2d at, double width, std::string_view low, std::string_view high) {
    for (double x = 0; x < width; ++x)
        f.fill({at.x + x, at.y, 1, 14}, heat(x / (width - 1)));
    f.text({at.x - 10, at.y + 12}, low, lettering::right);
    f.text({at.x + width + 10, at.y + 12}, high);
}

void draw_mask(Figure& f, Vec2d origin, int side, ImageView<const float> mask, Rgb8 color) {
    Image<Rgb8> colors(mask.width * side, mask.height * side);
    for (int y = 0; y < colors.height; ++y) {
        for (int x = 0; x < colors.width; ++x)
            colors(x, y) = mix(ink::panel, color, static_cast<double>(mask(x / side, y / side)));
    }
    f.image(static_cast<int>(origin.x), static_cast<int>(origin.y), colors, 1);
    f.frame({origin.x, origin.y, static_cast<double>(colors.width), static_cast<double>(colors.height)},
            {ink::soft, 1});
}

void decade_axes(Figure& f, const Plot& plot, bool x_too, std::string_view x_name, std::string_view y_name) {
    f.axes(plot, "", y_name);
    const auto power_of_ten = [](double e) {
        constexpr const char* small[] = {"0.01", "0.1", "1", "10", "100", "1000"};
        const int n = static_cast<int>(e);
        return n >= -2 && n <= 3 ? std::string(small[n + 2]) : fmt::format("1e{}", n);
    };
    for (double e = std::ceil(plot.y0); e <= plot.y1; ++e) {
        f.line(plot.at(plot.x0, e), plot.at(plot.x1, e), {ink::grid, 1});
        f.text(plot.at(plot.x0, e) + Vec2d{-8, 4}, power_of_ten(e), {8.5, ink::soft, Align::right});
    }
    for (double e = std::ceil(plot.x0); x_too && e <= plot.x1; ++e) {
        f.line(plot.at(e, plot.y0), plot.at(e, plot.y1), {ink::grid, 1});
        f.text(plot.at(e, plot.y0) + Vec2d{0, 18}, power_of_ten(e), lettering::tick);
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

}  // namespace obscura
