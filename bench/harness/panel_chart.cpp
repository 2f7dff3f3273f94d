#include "bench/harness/panel_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

/// Canvas, titles and what all panels have in common.
std::string chart_head(const PanelChart& chart, double width, double height) {
    return fmt::format(
        "set terminal svg size {:.0f},{:.0f} dynamic noenhanced font 'sans-serif,13' background '#ffffff'\n"
        "set multiplot\nset clip two\n"
        "set label 1 {} at screen 0.5,{:.4f} center font ',17'\n"
        "set label 2 {} at screen 0.5,{:.4f} center tc rgb '#333333'\n"
        "set logscale xy\nset format y '%g'\nset tics nomirror\nset border 3 lc rgb '#888888'\n"
        "set grid lt 1 lc rgb '#dddddd' lw 0.6\nset key {} samplen 1\n{}\n",
        width, height, gnuplot_text(chart.title), 1 - 26 / height, gnuplot_text(chart.note), 1 - 50 / height,
        chart.key, chart.x_tics);
}

/// Data and the plot command of panel `i`.
std::string panel_plot(const PanelChart& chart, std::size_t i) {
    const std::vector<PanelLine>& lines = chart.panels[i].lines;
    std::string data, plot;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const PanelLine& line = lines[l];
        data += fmt::format("$p{}_{} << EOD\n", i, l);
        for (const PanelPoint& p : line.points)
            data += fmt::format("{:.6g} {:.6g}\n", p.x, p.y);
        data += "EOD\n";
        const MethodStyle style = chart.style_of(line.method);
        const std::string look = line.plain ? fmt::format("lines lw 1.6 dt {}", line.hollow ? 3 : 1)
                                            : fmt::format("linespoints lw 1.6 ps 0.7 pt {}",
                                                          line.hollow ? style.hollow : style.filled);
        plot += fmt::format("{} $p{}_{} with {} lc rgb '{}' title {}", plot.empty() ? "plot" : ",", i, l,
                            look, style.color, gnuplot_text(line.name.empty() ? line.method : line.name));
    }
    return data + plot + '\n';
}

/// One key for all panels, in rows under the titles: an empty plot of every line that some panel has.
std::string key_strip(const PanelChart& chart, double bottom, double height) {
    std::vector<std::string> names;
    std::string plot;
    for (const Panel& panel : chart.panels) {
        for (const PanelLine& line : panel.lines) {
            if (std::find(names.begin(), names.end(), line.method) != names.end()) continue;
            names.push_back(line.method);
            const MethodStyle style = chart.style_of(line.method);
            plot += fmt::format("{} NaN with linespoints lw 1.6 ps 0.8 pt {} lc rgb '{}' title {}",
                                plot.empty() ? "plot [0:1] [0:1]" : ",", style.filled, style.color,
                                gnuplot_text(line.method));
        }
    }
    return fmt::format(
        "unset logscale\nunset arrow\nunset border\nunset tics\nunset grid\nset origin 0,{:.4f}\nset size "
        "1,{:.4f}\n"
        "set lmargin at screen 0.04\nset rmargin at screen 0.98\nset key center center horizontal maxrows "
        "{:.0f} samplen 2\n{}\nunset key\nunset label\nset lmargin -1\nset rmargin -1\nset border 3\n"
        "set xtics nomirror\nset ytics nomirror\nset logscale xy\nset grid lt 1 lc rgb '#dddddd' lw "
        "0.6\n{}\n",
        bottom, height, std::floor(chart.key_height / 23), plot, chart.x_tics);
}

}  // namespace

std::string panel_script(const PanelChart& chart) {
    CHECK(chart.style_of != nullptr);
    const auto count = static_cast<int>(chart.panels.size());
    const int columns = std::min(count, chart.columns), rows = (count + columns - 1) / columns;
    const double strip = chart.key_strip ? chart.key_height : 0;
    const double height = 110.0 + strip + chart.panel_height * rows;
    const double width = std::max(60.0 + 370.0 * columns, 800.0);
    const double top = (80 + strip) / height, bottom = 30 / height;
    const double cell_w = 1.0 / columns, cell_h = (1 - top - bottom) / rows;
    std::string script = chart_head(chart, width, height);
    if (chart.key_strip) script += key_strip(chart, 1 - top, strip / height);
    for (int i = 0; i < count; ++i) {
        const Panel& panel = chart.panels[static_cast<std::size_t>(i)];
        const std::string y_label = panel.y_label.empty() && i % columns == 0 ? chart.y_label : panel.y_label;
        const int column = i % columns, row = i / columns;
        const bool names_x = !chart.one_key || i + columns >= count;
        script += fmt::format(
            "set origin {:.4f},{:.4f}\nset size {:.4f},{:.4f}\nset title {} offset 0,-0.6\n", column * cell_w,
            1 - top - (row + 1) * cell_h, cell_w, cell_h, gnuplot_text(panel.title));
        script += fmt::format("set xlabel {} offset 0,0.4\nset ylabel {} offset 1,0\n",
                              gnuplot_text(names_x ? chart.x_label : ""), gnuplot_text(y_label));
        if (chart.one_key && i == columns) script += "unset key\n";
        script += panel_plot(chart, static_cast<std::size_t>(i)) + "unset label\n";
    }
    return script + "unset multiplot\n";
}

}  // namespace obscura
