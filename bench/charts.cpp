#include "bench/charts.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <sstream>

#include "bench/report.h"
#include "core/error.h"
#include "core/file_output.h"

namespace obscura {
namespace {

/// One line of a chart: a scene's heading, or one method with a point per thread count.
struct ChartLine {
    std::string label;
    std::string contestant;  ///< empty: a heading
    std::vector<const BenchRow*> rows;
};

/// Colour (Okabe and Ito's palette for every kind of colour vision) and gnuplot point types of a contestant.
struct Style {
    const char* color;
    int hollow, filled;
};

Style style_of(const std::string& contestant) {
    if (contestant == our_name) return {"#0072B2", 6, 7};
    if (contestant == "llvmpipe") return {"#D55E00", 4, 5};
    if (contestant == "Embree") return {"#009E73", 8, 9};
    return {"#555555", 12, 13};
}

std::string size_text(const BenchRow& row) {
    return fmt::format("{} x {}", row.width, row.height);
}

std::string title_of(const BenchRow& row) {
    switch (row.workload) {
        case Workload::depth:
            return "Nearest depth per texel of a light view, " + size_text(row);
        case Workload::dual_depth:
            return "First and second depth per texel of a light view, " + size_text(row);
        case Workload::frame:
            return "Shaded frame with shadows, " + size_text(row);
    }
    return {};
}

std::vector<ChartLine> lines_of(const std::vector<BenchRow>& rows, Workload workload) {
    std::vector<ChartLine> lines;
    for (const std::string& scene : scenes_of(rows)) {
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

/// gnuplot's single-quoted string.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'') out += '\'';
        out += c;
    }
    return out + '\'';
}

std::string ratios_text(const std::vector<BenchRow>& rows, const ChartLine& line) {
    std::string text;
    for (const BenchRow* row : line.rows) {
        const std::optional<double> ratio = ratio_to_ours(rows, *row);
        const std::string value = ratio ? fmt::format("{:.{}f}x", *ratio, *ratio < 10 ? 1 : 0) : "-";
        text += (text.empty() ? "" : "  /  ") + value;
    }
    return text;
}

/// Widest range of the times in whole 1-2-5 steps is left to gnuplot; we only keep it from clipping the bars.
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

/// One data block per contestant and thread count, and the plot command over them.
void write_points(std::string& script, const std::vector<ChartLine>& lines, const std::vector<int>& threads) {
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
                    if (row->threads != threads[t]) continue;
                    const auto [low, high] = std::minmax_element(row->runs_ms.begin(), row->runs_ms.end());
                    script +=
                        fmt::format("{:.4f} {} {:.4f} {:.4f}\n", median(row->runs_ms), y + 1, *low, *high);
                }
            }
            script += "EOD\n";
            const Style style = style_of(contestants[c]);
            const int point = t == 0 && threads.size() > 1 ? style.hollow : style.filled;
            plot += fmt::format(
                "{} $points_{}_{} using 1:2:3:4 with xerrorbars lw 1.6 ps 0.9 pt {} lc rgb '{}' title {}",
                plot.empty() ? "plot" : ",", c, t, point, style.color,
                quoted(
                    fmt::format("{}, {} thread{}", contestants[c], threads[t], threads[t] == 1 ? "" : "s")));
        }
    }
    script += plot + '\n';
}

bool in_path(const char* program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (access((folder + '/' + program).c_str(), X_OK) == 0) return true;
    }
    return false;
}

/// Feeds `script` to gnuplot, which writes `file`. Throws OutputError when it fails.
void run_gnuplot(const std::string& script, const std::filesystem::path& file) {
    const std::filesystem::path part = file.string() + ".part";
    FILE* gnuplot = popen("gnuplot", "w");
    if (gnuplot == nullptr) throw OutputError("gnuplot cannot be started");
    const std::string whole = fmt::format("set output {}\n{}", quoted(part.string()), script);
    const bool written = std::fwrite(whole.data(), 1, whole.size(), gnuplot) == whole.size();
    const int status = pclose(gnuplot);
    std::error_code error;
    if (written && status == 0) std::filesystem::rename(part, file, error);
    if (!written || status != 0 || error) {
        throw OutputError(fmt::format("{}: gnuplot could not draw it", file.string()));
    }
}

}  // namespace

std::string chart_script(const std::vector<BenchRow>& rows, Workload workload, const BenchOptions& options) {
    const std::vector<ChartLine> lines = lines_of(rows, workload);
    if (lines.empty()) return {};
    const double height = 190.0 + 19.0 * static_cast<double>(lines.size());
    const auto [low, high] = time_range(lines);
    const double count = static_cast<double>(lines.size());
    const BenchRow& first = *lines[1].rows[0];
    std::string script;
    const auto add = [&](const std::string& line) { script += line + '\n'; };
    add(fmt::format(
        "set terminal svg size 1120,{:.0f} dynamic noenhanced font 'sans-serif,13' background '#ffffff'",
        height));
    add(fmt::format("set multiplot title {} font ',16'", quoted(title_of(first))));
    add("set lmargin screen 0.36\nset rmargin screen 0.86");
    add(fmt::format("set tmargin screen {:.4f}\nset bmargin screen {:.4f}", 1 - 70.0 / height,
                    120.0 / height));
    add("set logscale x\nset xlabel 'time in ms, logarithmic; left is faster; bars: least to greatest of the "
        "runs'");
    add(fmt::format("set xrange [{:.4f}:{:.4f}]\nset yrange [{:.1f}:0.2]", low, high, count + 0.8));
    add("set format x '%g'\nset grid xtics mxtics lc rgb '#cccccc' lw 0.6, lc rgb '#eeeeee' lw 0.4\nset "
        "border 1 lc rgb '#888888'");
    add("set tics nomirror\nunset ytics");
    add(fmt::format("set key at screen 0.5,{:.4f} center bottom horizontal maxcols 4 samplen 1",
                    12.0 / height));
    std::string thread_text;
    for (const int t : options.threads)
        thread_text += fmt::format("{}{}", thread_text.empty() ? "" : " / ", t);
    add(fmt::format("set label {} at screen 0.87,{:.4f} left tc rgb '#333333'", quoted("time / Obscura's, "),
                    1 - 44.0 / height));
    add(fmt::format("set label {} at screen 0.87,{:.4f} left tc rgb '#333333'",
                    quoted(thread_text + " threads"), 1 - 60.0 / height));
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const ChartLine& line = lines[i];
        const bool heading = line.contestant.empty();
        add(fmt::format("set label {} at graph -0.01, first {} right {}", quoted(line.label), i + 1,
                        heading ? "font ',14' tc rgb '#000000'"
                                : fmt::format("tc rgb '{}'", style_of(line.contestant).color)));
        if (heading && i > 0) {
            add(fmt::format(
                "set arrow from screen 0.02, first {0} to screen 0.98, first {0} nohead lc rgb '#bbbbbb'",
                static_cast<double>(i) + 0.45));
        }
        if (!heading) {
            add(fmt::format("set label {} at screen 0.87, first {} left tc rgb '{}'",
                            quoted(ratios_text(rows, line)), i + 1, style_of(line.contestant).color));
        }
    }
    if (std::any_of(lines.begin(), lines.end(),
                    [](const ChartLine& line) { return !line.rows.empty() && !line.rows[0]->same_work; })) {
        add(
            fmt::format("set label '* not the whole work, or another result: see bench/README.md' at screen "
                        "0.02,{:.4f} left "
                        "tc rgb '#333333'",
                        58.0 / height));
    }
    write_points(script, lines, options.threads);
    add("unset multiplot");
    return script;
}

void draw_charts(const std::vector<BenchRow>& rows, const BenchOptions& options) {
    if (!in_path("gnuplot")) {
        options.say("gnuplot is not installed (package gnuplot-nox): tables only, no charts");
        return;
    }
    for (const Workload workload : {Workload::depth, Workload::dual_depth, Workload::frame}) {
        const std::string script = chart_script(rows, workload, options);
        if (script.empty()) continue;
        run_gnuplot(script, options.out / fmt::format("raster_{}.svg", workload_file_name(workload)));
    }
}

}  // namespace obscura
