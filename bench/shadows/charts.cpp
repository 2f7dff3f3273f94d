#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "bench/harness/gnuplot.h"
#include "bench/harness/panel_chart.h"
#include "bench/harness/report.h"
#include "bench/shadows/report.h"
#include "bench/shadows/summary.h"

namespace obscura {
namespace {

/// A panel per scene; `x_of` picks the abscissa of a row.
PanelChart accuracy_chart(const std::vector<AccuracyRow>& rows,
                          const std::function<double(const AccuracyRow&)>& x_of) {
    PanelChart chart;
    chart.style_of = shadow_style;
    chart.y_label = "wrong pixels, %";
    for (const std::string& scene : distinct(rows, &AccuracyRow::scene)) {
        std::vector<PanelLine> lines;
        for (const AccuracyRow& row : rows) {
            if (row.scene != scene || row.wrong.wrong == 0 || row.size == 0) continue;
            if (lines.empty() || lines.back().method != row.method) lines.push_back({row.method, {}});
            lines.back().points.push_back({x_of(row), 100 * row.wrong.fraction()});
        }
        if (!lines.empty()) chart.panels.push_back({scene, {}, std::move(lines)});
    }
    return chart;
}

PanelChart tree_chart(const std::vector<SizeRow>& rows) {
    PanelChart chart;
    chart.style_of = shadow_style;
    chart.title = "Memory of trees and of dense maps";
    chart.key = "top left";
    chart.note = "Four bytes per texel of dense maps; both axes logarithmic.";
    chart.x_label = "texels a side";
    chart.y_label = "MB";
    chart.x_tics = size_tics();
    for (const std::string& scene : distinct(rows, &SizeRow::scene)) {
        PanelLine tree{compressed_name, {}}, dense{dense_name, {}};
        for (const SizeRow& row : rows) {
            if (row.scene != scene || !row.problem.empty()) continue;
            tree.points.push_back({static_cast<double>(row.size), static_cast<double>(row.words24) * 1e-6});
            dense.points.push_back(
                {static_cast<double>(row.size), 4e-6 * row.size * static_cast<double>(row.size)});
        }
        if (!tree.points.empty()) chart.panels.push_back({scene, {}, {dense, tree}});
    }
    return chart;
}

/// A line of the chart of lookups: a scene's heading (no rows), or one job of one method.
struct RateLine {
    std::string label, method;
    std::vector<const TimeRow*> rows;  ///< one per thread count
};

std::vector<RateLine> rate_lines(const std::vector<TimeRow>& rows) {
    std::vector<RateLine> lines;
    for (const std::string& scene : distinct(rows, &TimeRow::scene)) {
        lines.push_back({scene, "", {}});
        const auto first = static_cast<std::ptrdiff_t>(lines.size());
        for (const TimeRow& row : rows) {
            if (row.scene != scene || row.rate() <= 0) continue;
            const std::string label = fmt::format("{}, {}", method_name(row.method, row.size), row.job);
            const auto same = std::find_if(lines.begin() + first, lines.end(),
                                           [&](const RateLine& line) { return line.label == label; });
            if (same == lines.end()) {
                lines.push_back({label, row.method, {&row}});
            } else {
                same->rows.push_back(&row);
            }
        }
    }
    return lines;
}

/// Canvas, axis and titles for `count` lines.
std::string lookup_frame(std::size_t count) {
    const double lines = static_cast<double>(count), height = 130.0 + 18.0 * lines;
    return fmt::format(
        "set terminal svg size 1000,{:.0f} dynamic noenhanced font 'sans-serif,13' background '#ffffff'\n"
        "set label {} at screen 0.5,{:.4f} center font ',17'\n"
        "set label 'Medians. Hollow: one thread; filled: more. Further right is faster.' at screen "
        "0.02,{:.4f} tc rgb '#333333'\n"
        "set lmargin screen 0.30\nset rmargin screen 0.95\nset tmargin screen {:.4f}\nset bmargin screen "
        "{:.4f}\nset logscale x\nset format x '%g'\nset xtics (1,2,5,10,20,50,100,200,500,1000)\n"
        "set tics nomirror\nunset ytics\nset border 1 lc rgb '#888888'\n"
        "set grid xtics lt 1 lc rgb '#c8c8c8' lw 0.8\nset xlabel 'million lookups per second and thread "
        "(logarithmic)'\nset yrange [{:.1f}:0.2]\n",
        height, gnuplot_text("Shadow lookups at the pixels of a 1920 x 1080 picture"), 1 - 22 / height,
        1 - 48 / height, 1 - 62 / height, 58 / height, lines + 0.8);
}

std::string lookup_script(const std::vector<TimeRow>& rows) {
    const std::vector<RateLine> lines = rate_lines(rows);
    std::string script = lookup_frame(lines.size()), plot;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const bool heading = lines[i].rows.empty();
        const MethodStyle style = shadow_style(lines[i].method);
        script += fmt::format("set label {} at screen {}, first {} {} tc rgb '{}'{}\n",
                              gnuplot_text(lines[i].label), heading ? 0.02 : 0.29, i + 1,
                              heading ? "left" : "right", heading ? "#000000" : style.color,
                              heading ? " font ',14'" : "");
        for (const TimeRow* row : lines[i].rows) {
            const std::string block = fmt::format("$r{}_{}", i, row->threads);
            script += fmt::format("{} << EOD\n{:.4f} {}\nEOD\n", block, row->rate(), i + 1);
            plot +=
                fmt::format("{} {} with points ps 0.8 pt {} lc rgb '{}' notitle", plot.empty() ? "plot" : ",",
                            block, row->threads == 1 ? style.hollow : style.filled, style.color);
        }
    }
    return plot.empty() ? std::string() : script + plot + '\n';
}

}  // namespace

MethodStyle shadow_style(const std::string& method) {
    if (method == compressed_name) return {"#0072B2", 6, 7};
    if (method == dense_name) return {"#D55E00", 4, 5};
    if (method == exact_name) return {"#CC79A7", 12, 13};
    return {"#009E73", 8, 9};
}

std::string size_tics() {
    std::string tics = "set xtics (";
    for (int size = 1024; size <= 1 << 20; size *= 4)
        tics += fmt::format("{}'{}' {}", size == 1024 ? "" : ", ", size_name(size), size);
    return tics + ")";
}

void draw_shadow_charts(const ShadowResults& results, const BenchOptions& options) {
    if (!can_draw(options)) return;
    const PanelChart summary = summary_chart(results);
    if (!summary.panels.empty()) run_gnuplot(panel_script(summary), options.out / "shadows_summary.svg");
    PanelChart by_size = accuracy_chart(results.accuracy,
                                        [](const AccuracyRow& row) { return static_cast<double>(row.size); });
    by_size.title = "Wrong shadows against the size of the map";
    by_size.note =
        "Pixels of a 1920 x 1080 picture that differ from exact shadow rays; both axes logarithmic.";
    by_size.x_label = "texels a side";
    by_size.x_tics = size_tics();
    PanelChart by_bytes = accuracy_chart(
        results.accuracy, [](const AccuracyRow& row) { return static_cast<double>(row.bytes) * 1e-6; });
    by_bytes.title = "Wrong shadows against memory";
    by_bytes.note = by_size.note;
    by_bytes.one_key = true;  // no corner is free in all panels
    by_bytes.x_label = "MB";
    by_bytes.x_tics = "set format x '%g'";
    if (!by_size.panels.empty()) {
        run_gnuplot(panel_script(by_size), options.out / "shadows_accuracy.svg");
        run_gnuplot(panel_script(by_bytes), options.out / "shadows_bytes.svg");
    }
    const PanelChart trees = tree_chart(results.sizes);
    if (!trees.panels.empty()) run_gnuplot(panel_script(trees), options.out / "shadows_trees.svg");
    const std::string lookups = lookup_script(results.times);
    if (!lookups.empty()) run_gnuplot(lookups, options.out / "shadows_lookups.svg");
}

}  // namespace obscura
