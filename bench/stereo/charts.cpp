// The stereo bench's chart: error against time, a column of panels per size.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/harness/panel_chart.h"
#include "bench/stereo/report.h"

namespace obscura {
namespace {

constexpr const char* goal_line = "goal";
constexpr double exact_px = 2e-5;  // direct solvers are drawn at the lower edge

std::vector<PanelPoint> points_of(const StereoRow& row, double MapError::*error) {
    std::vector<PanelPoint> points;
    for (const CurvePoint& point : row.curve)
        points.push_back({point.ms, std::max(point.error.*error, exact_px)});
    return points;
}

/// Lines of one size.
Panel panel_of(const StereoResults& results, int width, int height, double MapError::*error,
               const char* what) {
    Panel panel;
    panel.title = fmt::format("{} x {}: {}", width, height, what);
    for (const StereoRow& row : results.rows) {
        if (row.width != width || row.height != height || row.curve.empty() || row.threads > 2) continue;
        PanelLine line;
        line.method = row.method;
        line.points = points_of(row, error);
        line.hollow = row.threads == 1 && !row.peer;
        panel.lines.push_back(std::move(line));
    }
    // The goal, from the first point's time to the last one's.
    double first = INFINITY, last = 0;
    for (const PanelLine& line : panel.lines) {
        for (const PanelPoint& p : line.points)
            first = std::min(first, p.x), last = std::max(last, p.x);
    }
    if (last > 0) {
        const MapError goal{stereo_goal_max_px, stereo_goal_rms_px};
        panel.lines.push_back({goal_line, {{first, goal.*error}, {last, goal.*error}}, true, true});
    }
    return panel;
}

}  // namespace

MethodStyle stereo_style(const std::string& method) {
    static const std::map<std::string, MethodStyle> styles = {
        {multigrid_name, {"#0072B2", 6, 7}}, {fmg_name, {"#009E73", 8, 9}},
        {vcycle_name, {"#CC79A7", 10, 11}},  {cascade_name, {"#000000", 4, 5}},
        {printed_name, {"#999999", 4, 5}},   {half_name, {"#56B4E9", 4, 5}},
        {cg_name, {"#D55E00", 12, 13}},      {cg_ic_name, {"#E69F00", 12, 13}},
        {ldlt_name, {"#E69F00", 2, 2}},      {cholmod_name, {"#D55E00", 3, 3}},
        {goal_line, {"#888888", 0, 0}},
    };
    const auto found = styles.find(method);
    return found == styles.end() ? MethodStyle{"#009E73", 8, 9} : found->second;
}

void draw_stereo_chart(const StereoResults& results, const BenchOptions& options) {
    if (!can_draw(options, "chart")) return;
    std::vector<std::pair<int, int>> sizes;
    for (const StereoRow& row : results.rows) {
        if (std::find(sizes.begin(), sizes.end(), std::pair(row.width, row.height)) == sizes.end())
            sizes.emplace_back(row.width, row.height);
    }
    PanelChart chart;
    chart.style_of = stereo_style;
    chart.title = "Disparity optimisation: error against time";
    chart.note =
        "Base case. Hollow: one thread, filled: two threads, or a peer with one. Left is faster, down more "
        "accurate. Direct solvers stand at the lower edge.";
    chart.x_label = "milliseconds, whole call";
    chart.y_label = "pixels";
    chart.columns = static_cast<int>(sizes.size());
    chart.panel_height = 330;
    chart.key_strip = true;
    chart.key_height = 100;
    chart.one_key = true;
    chart.x_tics = fmt::format("set format x '%g'\nset format y '%g'\nset yrange [{:g}:100]", 0.7 * exact_px);
    for (const auto& [width, height] : sizes)
        chart.panels.push_back(panel_of(results, width, height, &MapError::rms_px, "rms error"));
    for (const auto& [width, height] : sizes)
        chart.panels.push_back(panel_of(results, width, height, &MapError::max_px, "largest error"));
    if (!chart.panels.empty()) run_gnuplot(panel_script(chart), options.out / "stereo.svg");
}

}  // namespace obscura
