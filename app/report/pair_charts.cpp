#include "app/report/pair_charts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/report/html_text.h"
#include "core/num.h"

namespace obscura {
namespace {

constexpr int width = 720, height = 300;
constexpr double left = 64, right = 700, top = 24, bottom = 236;
constexpr int bins = 96;

std::string open_svg(int chart_height, const std::string& title) {
    return fmt::format(
        "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" preserveAspectRatio=\"xMidYMid meet\">",
        width, chart_height, html_text(title));
}

std::string line(double x0, double y0, double x1, double y1, const char* style) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>", x0, y0,
                       x1, y1, style);
}

std::string words(double x, double y, const char* anchor, const char* style, const std::string& text) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" class=\"{}\">{}</text>", x, y,
                       anchor, style, html_text(text));
}

double decade(double v) {
    return num::log2(v) * 0.30102999566398120;
}

/// No "-0".
std::string number(double v) {
    return fmt::format("{:.6g}", std::fabs(v) < 1e-12 ? 0.0 : v);
}

}  // namespace

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

std::string time_text(double seconds) {
    return seconds < 0.1 ? fmt::format("{:.2f} ms", 1000 * seconds) : fmt::format("{:.2f} s", seconds);
}

DisparityHistogram disparity_histogram(const MiddleView& view, const DisparityMap& optimised,
                                       const ComfortZone& zone) {
    DisparityHistogram h;
    std::vector<double> before, after;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = view.margin_px; x < view.width() - view.margin_px; ++x) {
            if (view.object(x, y) == nothing_seen) continue;
            before.push_back(static_cast<double>(view.disparity(x, y)));
            after.push_back(static_cast<double>(optimised(x, y)));
        }
    }
    h.pixels = static_cast<std::int64_t>(after.size());
    h.before.assign(bins, 0.0);
    h.after.assign(bins, 0.0);
    if (after.empty()) return h;
    const auto [b0, b1] = std::minmax_element(before.begin(), before.end());
    const auto [a0, a1] = std::minmax_element(after.begin(), after.end());
    h.before_low = *b0, h.before_high = *b1, h.after_low = *a0, h.after_high = *a1;
    // The screen is on the axis; so are the zone's ends where pixels come near them.
    const double low = std::min({*b0, *a0, -0.5}), high = std::max({*b1, *a1, 0.5});
    h.step_px = 1.08 * (high - low) / bins;
    h.first_px = 0.5 * (low + high) - 0.5 * bins * h.step_px;
    const double unit = 1.0 / static_cast<double>(after.size());
    const auto add = [&](const std::vector<double>& values, std::vector<double>& shares, double& near_percent,
                         double& far_percent) {
        for (const double d : values) {
            const int bin = static_cast<int>((d - h.first_px) / h.step_px);
            shares[static_cast<std::size_t>(std::clamp(bin, 0, bins - 1))] += unit;
            near_percent += d > zone.nearest_px + 0.05 ? 100 * unit : 0;
            far_percent += d < zone.farthest_px - 0.05 ? 100 * unit : 0;
        }
    };
    add(before, h.before, h.near_percent_before, h.far_percent_before);
    add(after, h.after, h.near_percent, h.far_percent);
    return h;
}

std::string histogram_svg(const DisparityHistogram& h, const ComfortZone& zone, int picture_width) {
    const double low = h.first_px, high = h.first_px + bins * h.step_px;
    double most = 1e-9;
    for (std::size_t i = 0; i < h.after.size(); ++i)
        most = std::max({most, h.before[i], h.after[i]});
    const auto at_x = [&](double d) { return left + (right - left) * (d - low) / (high - low); };
    // Few bins hold walls and floors: the square root leaves the others visible.
    const auto at_y = [&](double share) { return bottom - (bottom - top) * std::sqrt(share / most); };
    std::string svg = open_svg(height, "Histogram of disparity before and after");
    const double zone0 = at_x(std::clamp(zone.farthest_px, low, high)),
                 zone1 = at_x(std::clamp(zone.nearest_px, low, high));
    if (zone.nearest_px < 1e8 || zone.farthest_px > -1e8) {
        svg += fmt::format("<rect x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\" class=\"zone\"/>",
                           zone0, top, std::max(zone1 - zone0, 0.0), bottom - top);
    }
    for (const double share : round_ticks(0, most, 4)) {
        svg += line(left, at_y(share), right, at_y(share), "grid");
        svg += words(left - 8, at_y(share) + 4, "end", "tick", number(100 * share) + " %");
    }
    const auto outline = [&](const std::vector<double>& shares, const char* style) {
        std::string points = fmt::format("{:.1f},{:.1f}", left, bottom);
        for (std::size_t i = 0; i < shares.size(); ++i) {
            const double x = low + static_cast<double>(i) * h.step_px;
            points += fmt::format(" {0:.1f},{2:.1f} {1:.1f},{2:.1f}", at_x(x), at_x(x + h.step_px),
                                  at_y(shares[i]));
        }
        return fmt::format("<polygon points=\"{} {:.1f},{:.1f}\" class=\"{}\"/>", points, right, bottom,
                           style);
    };
    svg += outline(h.before, "before") + outline(h.after, "after");
    svg += line(at_x(0), top - 6, at_x(0), bottom, "screen");
    svg += words(at_x(0), top - 10, "middle", "tick", "screen");
    svg += line(left, bottom, right, bottom, "axis");
    for (const double d : round_ticks(low, high, 9)) {
        svg += words(at_x(d), bottom + 18, "middle", "tick", number(d));
        svg += words(at_x(d), bottom + 34, "middle", "faint",
                     fmt::format("{:.2g} %", std::fabs(d) < 1e-9 ? 0.0 : 100 * d / picture_width));
    }
    svg += words(left, bottom + 54, "start", "faint", "farther");
    svg += words(right, bottom + 54, "end", "faint", "nearer");
    svg += words(0.5 * (left + right), bottom + 54, "middle", "tick",
                 "disparity in pixels, and in percent of the width");
    return svg + "</svg>";
}

std::string convergence_svg(const SolveReport& report, const SolverParams& params) {
    struct Curve {
        const char *style, *name;
        std::vector<double> values;
    };
    Curve curves[] = {{"residual", "residual", {}},
                      {"worst", "largest error, estimate (px)", {}},
                      {"rms", "rms error, estimate (px)", {}}};
    for (const SolveStep& step : report.steps) {
        curves[0].values.push_back(step.residual);
        curves[1].values.push_back(step.error_max_px);
        curves[2].values.push_back(step.error_rms_px);
    }
    double low = 1e300, high = 0;
    for (const Curve& c : curves) {
        for (const double v : c.values) {
            if (!(v > 0)) continue;
            low = std::min(low, v);
            high = std::max(high, v);
        }
    }
    if (!(high > 0)) return {};
    low = std::floor(decade(std::min(low, params.tolerance_rms_px)));
    high = std::max(std::ceil(decade(high)), low + 1);
    const auto count = static_cast<double>(report.steps.size());
    const double steps = std::max(count - 1, 1.0);
    const auto at_x = [&](double i) { return left + (right - left) * i / steps; };
    const auto at_y = [&](double v) {
        return bottom - (bottom - top) * (std::clamp(decade(v), low, high) - low) / (high - low);
    };
    std::string svg = open_svg(height, "Residual and error estimates against the iteration");
    for (double e = low; e <= high; ++e) {
        const double y = bottom - (bottom - top) * (e - low) / (high - low);
        svg += line(left, y, right, y, "grid");
        svg += words(
            left - 8, y + 4, "end", "tick",
            e >= -2 && e <= 3 ? number(num::exp2(e / 0.30102999566398120)) : fmt::format("1e{:.0f}", e));
    }
    svg += line(left, at_y(params.tolerance_max_px), right, at_y(params.tolerance_max_px), "worst limit");
    svg += line(left, at_y(params.tolerance_rms_px), right, at_y(params.tolerance_rms_px), "rms limit");
    for (const double i : round_ticks(0, steps, 10)) {
        if (std::floor(i) == i) svg += words(at_x(i), bottom + 18, "middle", "tick", number(i + 1));
    }
    double legend = left;
    for (const Curve& c : curves) {
        std::string points, dots;
        for (std::size_t i = 0; i < c.values.size(); ++i) {
            if (!(c.values[i] > 0)) continue;
            const double x = at_x(static_cast<double>(i)), y = at_y(c.values[i]);
            points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", x, y);
            dots +=
                fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" class=\"{} dot\"/>", x, y, c.style);
        }
        if (points.empty()) continue;
        svg += fmt::format("<polyline points=\"{}\" class=\"{} curve\"/>", points, c.style) + dots;
        svg += line(legend, bottom + 51, legend + 20, bottom + 51, fmt::format("{} curve", c.style).c_str());
        svg += words(legend + 27, bottom + 55, "start", "tick", c.name);
        legend += c.style[0] == 'r' && c.style[1] == 'e' ? 130.0 : 230.0;
    }
    svg += line(left, bottom, right, bottom, "axis");
    svg += words(right, bottom + 34, "end", "faint", "iteration; dashed: tolerances");
    return svg + "</svg>";
}

std::string bars_svg(const std::vector<ChartBar>& bars, const std::string& what) {
    constexpr double name_end = 170, bar_end = 610, pitch = 26;
    double most = 1e-12;
    for (const ChartBar& bar : bars)
        most = std::max(most, bar.seconds);
    std::string svg = open_svg(static_cast<int>(pitch * static_cast<double>(bars.size())) + 8, what);
    double y = 4;
    for (const ChartBar& bar : bars) {
        const double length = (bar_end - name_end) * bar.seconds / most;
        svg += words(name_end - 10, y + 15, "end", "tick", bar.name);
        svg += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"16\" rx=\"2\" class=\"bar\"/>",
            name_end, y + 2, std::max(length, 1.0));
        svg += words(name_end + length + 8, y + 15, "start", "tick", time_text(bar.seconds));
        y += pitch;
    }
    return svg + "</svg>";
}

}  // namespace obscura
