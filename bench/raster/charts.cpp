#include "bench/raster/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "bench/harness/gnuplot.h"
#include "bench/harness/report.h"
#include "bench/harness/run_times.h"
#include "bench/raster/report.h"

namespace obscura {
namespace {

/// One line of a chart: a scene's heading, or one method with a point per thread count.
struct ChartLine {
    std::string label;
    std::string contestant;  ///< empty: a heading
    std::vector<const BenchRow*> rows;
};

MethodStyle style_of(const std::string& contestant) {
    if (contestant == our_name) return {"#0072B2", 6, 7};
    if (contestant == "llvmpipe") return {"#D55E00", 4, 5};
    if (contestant == "Embree") return {"#009E73", 8, 9};
    return {"#555555", 12, 13};
}

std::vector<ChartLine> lines_of(const std::vector<BenchRow>& rows, Workload workload) {
    std::vector<ChartLine> lines;
    for (const std::string& scene : distinct(rows, &BenchRow::scene)) {
        bool headed = false;
        for (const BenchRow& row : rows) {
            if (row.scene != scene || row.workload != workload || row.runs_ms.empty()) continue;
            if (!headed) lines.push_back({fmt::format("{}: {} triangles", scene, row.triangles), "", {}});
            headed = true;
            const std::string label =
                fmt::format("{}: {}{}", row.contestant, row.method, row.same_work ? "" : " *");
            const auto same = std::find_if(lines.begin(), lines.end(), [&](const ChartLine& line) {
                return line.label == label && line.rows[0]->scene == scene;
            });
            if (same == lines.end()) {
                lines.push_back({label, row.contestant, {&row}});
            } else {
                same->rows.push_back(&row);
            }
        }
    }
    return lines;
}

/// "0.04x", "1.3x", "12x".
std::string ratio_text(double ratio) {
    return fmt::format("{:.{}f}x", ratio, ratio < 0.95 ? 2 : ratio < 9.5 ? 1 : 0);
}

std::string ratios_text(const std::vector<BenchRow>& rows, const ChartLine& line) {
    std::string text;
    for (const BenchRow* row : line.rows) {
        const std::optional<double> ratio = ratio_to_ours(rows, *row);
        text += (text.empty() ? "" : "  /  ") + (ratio ? ratio_text(*ratio) : std::string("-"));
    }
    return text;
}

/// From the fastest to the slowest run, with room at both ends.
std::array<double, 2> time_range(const std::vector<ChartLine>& lines) {
    double low = 1e300, high = 0;
    for (const ChartLine& line : lines) {
        for (const BenchRow* row : line.rows) {
            low = std::min(low, *std::min_element(row->runs_ms.begin(), row->runs_ms.end()));
            high = std::max(high, *std::max_element(row->runs_ms.begin(), row->runs_ms.end()));
        }
    }
    return {low / 1.5, high * 1.5};
}

/// Where the point of the t-th thread count stands: just above or below the middle of line y.
double point_height(std::size_t y, std::size_t t, std::size_t thread_counts) {
    const double share = (static_cast<double>(t) + 0.5) / static_cast<double>(thread_counts);
    return static_cast<double>(y) + 1.0 + 0.4 * (share - 0.5);
}

void add_point(std::string& script, const BenchRow& row, double height) {
    const auto [low, high] = std::minmax_element(row.runs_ms.begin(), row.runs_ms.end());
    script += fmt::format("{:.4f} {:.2f} {:.4f} {:.4f}\n", median(row.runs_ms), height, *low, *high);
}

/// One data block per contestant and thread count, and the plot command over them.
void add_points(std::string& script, const std::vector<ChartLine>& lines, const std::vector<int>& threads) {
    std::vector<std::string> contestants;
    for (const ChartLine& line : lines) {
        const bool known =
            std::find(contestants.begin(), contestants.end(), line.contestant) != contestants.end();
        if (!line.contestant.empty() && !known) contestants.push_back(line.contestant);
    }
    std::string plot;
    for (std::size_t c = 0; c < contestants.size(); ++c) {
        for (std::size_t t = 0; t < threads.size(); ++t) {
            script += fmt::format("$points_{}_{} << EOD\n", c, t);
            for (std::size_t y = 0; y < lines.size(); ++y) {
                if (lines[y].contestant != contestants[c]) continue;
                for (const BenchRow* row : lines[y].rows) {
                    if (row->threads == threads[t])
                        add_point(script, *row, point_height(y, t, threads.size()));
                }
            }
            script += "EOD\n";
            const MethodStyle style = style_of(contestants[c]);
            plot += fmt::format(
                "{} $points_{}_{} using 1:2:3:4 with xerrorbars lw 1.4 ps 0.8 pt {} lc rgb '{}' notitle",
                plot.empty() ? "plot" : ",", c, t, t == 0 && threads.size() > 1 ? style.hollow : style.filled,
                style.color);
        }
    }
    script += plot + '\n';
}

/// Canvas, axes and titles of a chart of `count` lines, `height` pixels high.
std::string frame_commands(const std::vector<ChartLine>& lines, const std::vector<int>& threads,
                           double height) {
    const auto [low, high] = time_range(lines);
    const auto from_top = [&](double px) { return 1 - px / height; };
    std::string script = fmt::format(
        "set terminal svg size 1160,{:.0f} dynamic noenhanced font 'sans-serif,13' background '#ffffff'\n"
        "set label {} at screen 0.5,{:.4f} center font ',17'\n"
        "set lmargin screen 0.39\nset rmargin screen 0.85\nset tmargin screen {:.4f}\nset bmargin screen "
        "{:.4f}\n"
        "set logscale x\nset format x '%g'\nset tics nomirror\nunset ytics\nset border 1 lc rgb '#888888'\n"
        "set grid xtics mxtics lt 1 lc rgb '#c8c8c8' lw 0.8, lt 1 lc rgb '#ececec' lw 0.5\n"
        "set xlabel 'time in ms (logarithmic; further left is faster)'\n"
        "set xrange [{:.4f}:{:.4f}]\nset yrange [{:.1f}:0.2]\n",
        height, gnuplot_text(workload_title(*lines[1].rows[0])), from_top(24), from_top(78), 84.0 / height,
        low, high, static_cast<double>(lines.size()) + 0.8);
    std::string all;
    for (const int t : threads)
        all += fmt::format("{}{}", all.empty() ? "" : " / ", t);
    const std::string key = threads.size() == 1 ? fmt::format("threads: {}", threads[0])
                                                : fmt::format("hollow: {} thread, filled: more", threads[0]);
    script += fmt::format(
        "set label 'Points: medians ({}). Bars: least to greatest run.' at screen 0.02,{:.4f} tc rgb "
        "'#333333'\n"
        "set label 'time / Obscura' at screen 0.865,{:.4f} tc rgb '#333333'\n"
        "set label '{} threads' at screen 0.865,{:.4f} tc rgb '#333333'\n",
        key, from_top(58), from_top(48), all, from_top(64));
    return script;
}

/// What stands beside the points: scene headings, methods on the left, ratios on the right.
std::string label_commands(const std::vector<BenchRow>& rows, const std::vector<ChartLine>& lines,
                           double height) {
    std::string script;
    bool starred = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const ChartLine& line = lines[i];
        if (line.contestant.empty()) {
            script += fmt::format("set label {} at screen 0.02, first {} font ',14'\n",
                                  gnuplot_text(line.label), i + 1);
            script += fmt::format(
                "set arrow from screen 0.02, first {0} to screen 0.98, first {0} nohead lc rgb '#999999'\n",
                static_cast<double>(i) + 0.45);
            continue;
        }
        starred = starred || !line.rows[0]->same_work;
        const char* color = style_of(line.contestant).color;
        script += fmt::format("set label {} at screen 0.38, first {} right tc rgb '{}'\n",
                              gnuplot_text(line.label), i + 1, color);
        script += fmt::format("set label {} at screen 0.865, first {} tc rgb '{}'\n",
                              gnuplot_text(ratios_text(rows, line)), i + 1, color);
    }
    if (starred) {
        script += fmt::format(
            "set label '* not the whole work, or another result: see bench/README.md' at screen 0.02,{:.4f} "
            "tc rgb '#333333'\n",
            16.0 / height);
    }
    return script;
}

}  // namespace

std::string chart_script(const std::vector<BenchRow>& rows, Workload workload, const BenchOptions& options) {
    const std::vector<ChartLine> lines = lines_of(rows, workload);
    if (lines.empty()) return {};
    const double height = 170.0 + 20.0 * static_cast<double>(lines.size());
    std::string script = frame_commands(lines, options.threads, height) + label_commands(rows, lines, height);
    add_points(script, lines, options.threads);
    return script;
}

void draw_charts(const std::vector<BenchRow>& rows, const BenchOptions& options) {
    if (!can_draw(options)) return;
    for (const Workload workload : all_workloads) {
        const std::string script = chart_script(rows, workload, options);
        if (script.empty()) continue;
        run_gnuplot(script, options.out / fmt::format("raster_{}.svg", workload_file_name(workload)));
    }
}

}  // namespace obscura
