// Charts of the diffraction bench: a panel per aperture, a line per strategy or peer, one thread.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/diffraction/report.h"
#include "bench/harness/panel_chart.h"

namespace obscura {
namespace {

/// What of a row is drawn, and how its method is called.
struct Axes {
    std::function<double(const DiffractionRow&)> x, y;
};

/// Strategies whose tables can be kept appear with them.
bool is_drawn(const DiffractionRow& row, const std::vector<DiffractionRow>& rows) {
    if (row.time.calls == 0 || row.threads != 1) return false;
    return !row.one_call || row.part != far_part || least_ms(rows, row, row.method, false) == 0;
}

std::vector<Panel> panels_of(const std::vector<DiffractionRow>& rows, const std::string& part,
                             const Axes& axes) {
    std::vector<Panel> panels;
    for (const DiffractionRow& row : rows) {
        if (row.part != part || !is_drawn(row, rows) || !(axes.x(row) > 0) || !(axes.y(row) > 0)) continue;
        auto panel = std::find_if(panels.begin(), panels.end(),
                                  [&](const Panel& p) { return p.title == row.aperture; });
        if (panel == panels.end()) panel = panels.insert(panel, {row.aperture, {}, {}});
        auto line = std::find_if(panel->lines.begin(), panel->lines.end(),
                                 [&](const PanelLine& l) { return l.method == row.method; });
        if (line == panel->lines.end()) line = panel->lines.insert(line, {row.method, {}});
        line->points.push_back({axes.x(row), axes.y(row)});
    }
    return panels;
}

/// "set xtics (...)" with the sizes of a part.
std::string tics_of(const std::vector<DiffractionRow>& rows, const std::string& part) {
    std::map<int, int> sizes;
    for (const DiffractionRow& row : rows) {
        if (row.part == part) sizes[row.size] = 1;
    }
    std::string tics;
    for (const auto& [size, _] : sizes)
        tics += fmt::format("{}'{}' {}", tics.empty() ? "set xtics nomirror (" : ", ", size, size);
    return tics.empty() ? tics
                        : tics + fmt::format(")\nset xrange [{}:{}]", 0.8 * sizes.begin()->first,
                                             1.25 * sizes.rbegin()->first);
}

double time_of(const DiffractionRow& row) {
    return row.time.least_ms;
}

/// The same axis for all panels.
std::string y_range(const std::vector<Panel>& panels) {
    double least = INFINITY, largest = 0;
    for (const Panel& panel : panels) {
        for (const PanelLine& line : panel.lines) {
            for (const PanelPoint& p : line.points)
                least = std::min(least, p.y), largest = std::max(largest, p.y);
        }
    }
    return largest > 0 ? fmt::format("\nset yrange [{:.3g}:{:.3g}]", 0.6 * least, 1.6 * largest) : "";
}

PanelChart chart_of(const char* title, const char* note, std::vector<Panel> panels) {
    PanelChart chart;
    chart.style_of = diffraction_style;
    chart.title = title;
    chart.note = note;
    chart.panels = std::move(panels);
    chart.key_strip = true;
    return chart;
}

PanelChart time_chart(const std::vector<DiffractionRow>& rows, const std::string& part, const char* title,
                      const char* note, const char* x_label) {
    PanelChart chart = chart_of(
        title, note,
        panels_of(rows, part,
                  {[](const DiffractionRow& row) { return static_cast<double>(row.size); }, time_of}));
    chart.x_label = x_label;
    chart.y_label = "milliseconds";
    chart.x_tics = tics_of(rows, part) + y_range(chart.panels);
    return chart;
}

/// Error against time, the goal as a grey line.
PanelChart error_chart(const std::vector<DiffractionRow>& rows, const char* part, const char* title,
                       const char* y_label, double goal) {
    const auto known = rows_where(rows, [](const DiffractionRow& row) { return row.same_function; });
    PanelChart chart = chart_of(
        title,
        "A point per size, doubled from left to right; left is faster, down more accurate. Grey line: goal.",
        panels_of(known, part, {time_of, [](const DiffractionRow& row) { return row.error; }}));
    chart.x_label = "milliseconds";
    chart.y_label = y_label;
    chart.x_tics = fmt::format(
        "set format x '%g'\nset format y '%.0e'\nset yrange [5e-9:4e-6]\n"
        "set arrow 1 from graph 0, first {0:g} to graph 1, first {0:g} nohead lc rgb '#888888'",
        goal);
    return chart;
}

}  // namespace

MethodStyle diffraction_style(const std::string& method) {
    static const std::map<std::string, MethodStyle> styles = {
        {automatic_name, {"#000000", 12, 13}},
        {"runs", {"#0072B2", 6, 7}},
        {"hybrid", {"#0072B2", 6, 7}},
        {"raster_fft", {"#56B4E9", 4, 5}},
        {"fft", {"#56B4E9", 4, 5}},
        {"edges", {"#009E73", 8, 9}},
        {"levels", {"#CC79A7", 10, 11}},
        {"two_pass", {"#CC79A7", 10, 11}},
        {"gemm", {"#999999", 4, 5}},
        {"direct", {"#999999", 6, 7}},
        {"shift", {"#999999", 8, 9}},
        {"polygon", {"#F0E442", 14, 15}},
        {"chirp-z", {"#CC79A7", 14, 15}},
        {fftw_image_name, {"#E69F00", 8, 9}},
        {fftw_mask_name, {"#D55E00", 4, 5}},
        {fftw_padded_name, {"#D55E00", 4, 5}},
        {fftw_near_name, {"#D55E00", 4, 5}},
        {fftw_near8_name, {"#E69F00", 8, 9}},
    };
    const auto found = styles.find(method);
    return found == styles.end() ? MethodStyle{"#009E73", 8, 9} : found->second;
}

void draw_diffraction_charts(const DiffractionResults& results, const BenchOptions& options) {
    if (!can_draw(options)) return;
    const auto draw = [&](const PanelChart& chart, const char* file) {
        if (!chart.panels.empty()) run_gnuplot(panel_script(chart), options.out / file);
    };
    const std::vector<DiffractionRow>& rows = results.rows;
    draw(
        time_chart(rows, far_part, "Far field: time against size",
                   "Power over the half plane, one thread, tables and plans kept. Lower is better; both axes "
                   "logarithmic.",
                   "N, texels a side of the image"),
        "diffraction_time.svg");
    draw(error_chart(rows, far_part, "Far field: error against time",
                     "largest amplitude error, share of F(0, 0)", 1e-6),
         "diffraction_error.svg");
    draw(error_chart(rows, near_part, "Near field: error against time",
                     "largest error, share of the unit wave", 2e-6),
         "diffraction_near_error.svg");
    draw(
        time_chart(rows, window_part, "Windows of finer frequencies: time against size",
                   "Steps a quarter of the half plane's, one thread. Lower is better; both axes logarithmic.",
                   "N, twice the mask's side in texels"),
        "diffraction_window.svg");
    draw(time_chart(rows, near_part, "Near field: time against size",
                    "Fresnel number 10, one thread. Lower is better; both axes logarithmic.",
                    "M, texels a side of mask and plane"),
         "diffraction_near.svg");
}

}  // namespace obscura
