#include "app/report/pair_charts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "lessons/drawing/panels.h"
#include "lessons/drawing/svg_chart.h"

namespace obscura {
namespace {

constexpr int width = 720, height = 300;
constexpr Box plot{64, 24, 636, 212};
constexpr double right = plot.x + plot.w, bottom = plot.y + plot.h;
constexpr int bins = 96;

/// Steps along a histogram: bins of step_px from the axis's low end on, each as high as at_y() of its share.
template <class Height>
std::vector<Vec2d> outline(const std::vector<double>& shares, double step_px, const ChartAxis& across,
                           Height&& at_y) {
    std::vector<Vec2d> corners{{plot.x, bottom}};
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double begin = across.low + static_cast<double>(i) * step_px;
        corners.push_back({across.at(begin), at_y(shares[i])});
        corners.push_back({across.at(begin + step_px), at_y(shares[i])});
    }
    corners.push_back({right, bottom});
    return corners;
}

/// What is known of iterations, and the room that its name takes in the legend.
struct Curve {
    std::string_view look, name;
    double SolveStep::*value;
    double legend_width;
};
constexpr Curve curves[] = {{"residual", "residual", &SolveStep::residual, 130},
                            {"worst", "largest error, estimate (px)", &SolveStep::error_max_px, 230},
                            {"rms", "rms error, estimate (px)", &SolveStep::error_rms_px, 230}};

}  // namespace

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
    double most = 1e-9;
    for (std::size_t i = 0; i < h.after.size(); ++i)
        most = std::max({most, h.before[i], h.after[i]});
    const ChartAxis across{plot.x, right, h.first_px, h.first_px + bins * h.step_px};
    // Few bins hold walls and floors: the square root leaves the others visible.
    const ChartAxis root{bottom, plot.y, 0, 1};
    const auto at_y = [&](double share) { return root.at(std::sqrt(share / most)); };

    SvgChart chart(width, height, "Histogram of disparity before and after");
    if (zone.nearest_px < 1e8 || zone.farthest_px > -1e8) {
        const double far = across.at(std::clamp(zone.farthest_px, across.low, across.high)),
                     near = across.at(std::clamp(zone.nearest_px, across.low, across.high));
        chart.box({far, plot.y, std::max(near - far, 0.0), plot.h}, "zone");
    }
    for (const double share : round_ticks(0, most, 4))
        chart.level(plot, at_y(share), number_text(100 * share) + " %");
    for (const auto& [shares, look] : {std::pair{&h.before, "before"}, std::pair{&h.after, "after"}})
        chart.polygon(outline(*shares, h.step_px, across, at_y), look);
    const double screen = across.at(0);
    chart.line({screen, plot.y - 6}, {screen, bottom}, "screen");
    chart.text({screen, plot.y - 10}, Align::centre, "tick", "screen");
    chart.base(plot);
    for (const double d : round_ticks(across.low, across.high, 9)) {
        chart.number(plot, across.at(d), number_text(d));
        chart.text({across.at(d), bottom + 34}, Align::centre, "faint",
                   fmt::format("{:.2g} %", std::fabs(d) < 1e-9 ? 0.0 : 100 * d / picture_width));
    }
    chart.text({plot.x, bottom + 54}, Align::left, "faint", "farther");
    chart.text({right, bottom + 54}, Align::right, "faint", "nearer");
    chart.text({0.5 * (plot.x + right), bottom + 54}, Align::centre, "tick",
               "disparity in pixels, and in percent of the width");
    return chart.markup();
}

std::string convergence_svg(const SolveReport& report, const SolverParams& params) {
    double least = 1e300, most = 0;
    for (const SolveStep& step : report.steps) {
        for (const Curve& c : curves) {
            const double v = step.*c.value;
            if (!(v > 0)) continue;
            least = std::min(least, v);
            most = std::max(most, v);
        }
    }
    if (!(most > 0)) return {};
    const double low = std::floor(decades_of(std::min(least, params.tolerance_rms_px)));
    const ChartAxis decades{bottom, plot.y, low, std::max(std::ceil(decades_of(most)), low + 1)};
    const ChartAxis steps{plot.x, right, 0, std::max(static_cast<double>(report.steps.size()) - 1, 1.0)};
    const auto at_y = [&](double v) {
        return decades.at(std::clamp(decades_of(v), decades.low, decades.high));
    };

    SvgChart chart(width, height, "Residual and error estimates against the iteration");
    for (int e = static_cast<int>(decades.low); e <= static_cast<int>(decades.high); ++e)
        chart.level(plot, decades.at(e), power_of_ten_text(e));
    for (const auto& [tolerance, look] :
         {std::pair{params.tolerance_max_px, "worst limit"}, std::pair{params.tolerance_rms_px, "rms limit"}})
        chart.line({plot.x, at_y(tolerance)}, {right, at_y(tolerance)}, look);
    for (const double i : round_ticks(0, steps.high, 10)) {
        if (std::floor(i) == i) chart.number(plot, steps.at(i), number_text(i + 1));
    }
    double legend = plot.x;
    for (const Curve& c : curves) {
        std::vector<Vec2d> points;
        for (std::size_t i = 0; i < report.steps.size(); ++i) {
            const double v = report.steps[i].*c.value;
            if (v > 0) points.push_back({steps.at(static_cast<double>(i)), at_y(v)});
        }
        if (points.empty()) continue;
        const std::string look = fmt::format("{} curve", c.look), dot = fmt::format("{} dot", c.look);
        chart.polyline(points, look);
        for (const Vec2d p : points)
            chart.disc(p, 3, dot);
        chart.line({legend, bottom + 51}, {legend + 20, bottom + 51}, look);
        chart.text({legend + 27, bottom + 55}, Align::left, "tick", c.name);
        legend += c.legend_width;
    }
    chart.base(plot);
    chart.text({right, bottom + 34}, Align::right, "faint", "iteration; dashed: tolerances");
    return chart.markup();
}

std::string bars_svg(const std::vector<ChartBar>& bars, const std::string& what) {
    constexpr double name_end = 170, bar_end = 610, pitch = 26;
    double most = 1e-12;
    for (const ChartBar& bar : bars)
        most = std::max(most, bar.seconds);
    SvgChart chart(width, static_cast<int>(pitch * static_cast<double>(bars.size())) + 8, what);
    double y = 4;
    for (const ChartBar& bar : bars) {
        const double length = (bar_end - name_end) * bar.seconds / most;
        chart.text({name_end - 10, y + 15}, Align::right, "tick", bar.name);
        chart.box({name_end, y + 2, std::max(length, 1.0), 16}, "bar", 2);
        chart.text({name_end + length + 8, y + 15}, Align::left, "tick", time_text(bar.seconds));
        y += pitch;
    }
    return chart.markup();
}

}  // namespace obscura
