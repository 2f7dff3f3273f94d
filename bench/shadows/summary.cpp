#include "bench/shadows/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <tuple>

#include "app/scene/shadow_settings.h"
#include "bench/harness/report.h"
#include "bench/harness/run_times.h"
#include "bench/shadows/report.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

constexpr const char* packets = "packets of 16 rays";

/// Everything known about one method on one scene.
struct SummaryRow {
    MethodKey key;
    const AccuracyRow* accuracy = nullptr;
    std::int64_t bytes = 0;
    bool timed = false;
};

/// Scene by scene in the order of the results, dense before compressed before Embree, small before large.
std::vector<SummaryRow> summary_rows(const ShadowResults& results) {
    std::vector<SummaryRow> rows;
    std::vector<std::string> scenes;
    const auto row_of = [&](const std::string& scene, const std::string& method, int size) -> SummaryRow& {
        if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) scenes.push_back(scene);
        const MethodKey key{scene, method, size};
        const auto same =
            std::find_if(rows.begin(), rows.end(), [&](const SummaryRow& row) { return row.key == key; });
        return same != rows.end() ? *same : rows.emplace_back(SummaryRow{key});
    };
    for (const TimeRow& time : results.times) {
        const bool ours = time.method == dense_name || time.method == compressed_name;
        const bool rays = time.method == embree_name && time.size == 0;  // not the raster bench's maps
        if ((!ours && !rays) || time.runs_ms.empty()) continue;
        SummaryRow& row = row_of(time.scene, time.method, time.size);
        row.bytes = time.bytes;
        row.timed = true;
    }
    for (const AccuracyRow& accuracy : results.accuracy) {
        SummaryRow& row = row_of(accuracy.scene, accuracy.method, accuracy.size);
        row.accuracy = &accuracy;
        row.bytes = accuracy.bytes;
    }
    const auto rank = [&](const SummaryRow& row) {
        const int method = row.key.method == dense_name ? 0 : row.key.method == compressed_name ? 1 : 2;
        return std::tuple(std::find(scenes.begin(), scenes.end(), row.key.scene) - scenes.begin(), method,
                          row.key.size);
    };
    std::sort(rows.begin(), rows.end(),
              [&](const SummaryRow& a, const SummaryRow& b) { return rank(a) < rank(b); });
    return rows;
}

/// Embree's rays answer for one tap.
std::string job_of(const MethodKey& key, const std::string& kernel) {
    return key.method == embree_name && kernel == "1 tap" ? packets : kernel;
}

/// Seconds; 0 when not measured.
double build_s(const ShadowResults& results, const MethodKey& key, int threads) {
    const TimeRow* row = find_time(results.times, key, "build", threads);
    return row != nullptr ? 1e-3 * median(row->runs_ms) : 0;
}

/// Nanoseconds on the clock per pixel that faces the light; 0 when not measured.
double lookup_ns(const ShadowResults& results, const MethodKey& key, const std::string& kernel, int threads) {
    const TimeRow* row = find_time(results.times, key, job_of(key, kernel), threads);
    return row != nullptr && row->lookups > 0 ? 1e6 * median(row->runs_ms) / static_cast<double>(row->lookups)
                                              : 0;
}

std::string cell(double value, const char* format) {
    return value > 0 ? fmt::format(fmt::runtime(format), value) : std::string("-");
}

/// Whether the summary shows that line: all that was timed; where nothing is known of times, all.
bool is_shown(const SummaryRow& row, bool any_times) {
    return row.timed || !any_times;
}

void add_line(PanelChart& chart, const std::vector<SummaryRow>& rows, const std::string& method, bool hollow,
              const std::string& name, const std::function<double(const SummaryRow&)>& y_of) {
    PanelLine line{method, {}, hollow, method == embree_name, name};
    for (const SummaryRow& row : rows) {
        const double y = row.key.method == method ? y_of(row) : 0;
        if (y <= 0) continue;
        if (row.key.size > 0) {
            line.points.push_back({static_cast<double>(row.key.size), y});
        } else {
            line.points = {{1, y}, {1 << 24, y}};  // rays know no size of map
        }
    }
    if (!line.points.empty()) chart.panels.back().lines.push_back(std::move(line));
}

/// One quantity of one scene: a line per method, and per thread count where it is a time.
void add_panel(PanelChart& chart, const std::vector<SummaryRow>& rows, const std::vector<int>& threads,
               const std::string& title, const std::string& y_label,
               const std::function<double(const SummaryRow&, int threads)>& y_of) {
    chart.panels.push_back({title, y_label, {}});
    for (const char* method : {dense_name, compressed_name, embree_name}) {
        for (const int count : threads) {
            add_line(chart, rows, method, count == 1 && threads.size() > 1, method,
                     [&](const SummaryRow& row) { return y_of(row, count); });
        }
    }
}

/// Scenes with trees timed at more than one size; all that were timed when there is none.
std::vector<std::string> charted_scenes(const std::vector<SummaryRow>& rows) {
    std::vector<std::string> deep, all;
    std::string last;
    for (const SummaryRow& row : rows) {
        if (!row.timed || row.key.method != compressed_name) continue;
        if (row.key.scene != last) {
            all.push_back(row.key.scene);
        } else if (deep.empty() || deep.back() != last) {
            deep.push_back(last);
        }
        last = row.key.scene;
    }
    return deep.empty() ? all : deep;
}

}  // namespace

std::string summary_markdown(const ShadowResults& results) {
    const std::vector<SummaryRow> rows = summary_rows(results);
    if (rows.empty()) return {};
    const std::vector<int> threads = thread_counts(results.times);
    std::string text =
        "## Summary\n\n![chart](shadows_summary.svg)\n\nWrong pixels are those of one tap, against exact "
        "rays. Lookups: nanoseconds on the clock per pixel that faces the light, from its surface to its "
        "visibility, by all threads together; Embree's packets of 16 rays stand for one tap. Trees have the "
        "default top grid. Lookups of more kinds and sizes are below.\n\n| scene | method | wrong % | MB";
    const Out out(text);
    for (const char* what : {"build s", "1 tap ns", "3x3 ns"}) {
        for (const int count : threads)
            fmt::format_to(out, " | {}, {}", what, threads_text(count));
    }
    text += " |\n|---|---|--:|--:";
    for (std::size_t i = 0; i < 3 * threads.size(); ++i)
        text += "|--:";
    text += "|\n";
    for (const SummaryRow& row : rows) {
        if (!is_shown(row, !threads.empty())) continue;
        fmt::format_to(out, "| {} | {} | {} | {:.2f}", row.key.scene,
                       method_name(row.key.method, row.key.size),
                       row.accuracy != nullptr ? fmt::format("{:.4f}", 100 * row.accuracy->wrong.fraction())
                                               : std::string("-"),
                       static_cast<double>(row.bytes) * 1e-6);
        for (const int count : threads)
            fmt::format_to(out, " | {}", cell(build_s(results, row.key, count), "{:.3g}"));
        for (const char* kernel : {"1 tap", "3x3"}) {
            for (const int count : threads)
                fmt::format_to(out, " | {}", cell(lookup_ns(results, row.key, kernel, count), "{:.1f}"));
        }
        text += " |\n";
    }
    return text;
}

PanelChart summary_chart(const ShadowResults& results) {
    const std::vector<SummaryRow> rows = summary_rows(results);
    const std::vector<std::string> scenes = charted_scenes(rows);
    const std::vector<int> threads = thread_counts(results.times);
    PanelChart chart;
    chart.style_of = shadow_style;
    chart.title = "Shadows: error, memory, build and lookups against the size of the map";
    chart.note = threads.size() > 1 ? "Times: hollow or dashed with one thread, filled or solid with more. "
                                      "Lower is better everywhere; all axes logarithmic."
                                    : "Lower is better everywhere; all axes logarithmic.";
    chart.x_label = "texels a side";
    int least = most_map_resolution, most = 1;
    for (const SummaryRow& row : rows) {
        if (row.key.size > 0) least = std::min(least, row.key.size), most = std::max(most, row.key.size);
    }
    chart.x_tics = size_tics() + fmt::format("\nset xrange [{}:{}]", 0.75 * least, 1.33 * most);
    chart.columns = static_cast<int>(scenes.size());
    chart.panel_height = 215;
    chart.one_key = true;
    const auto each_scene = [&](const char* what,
                                const std::function<double(const SummaryRow&, int threads)>& y_of,
                                const std::vector<int>& counts) {
        for (const std::string& scene : scenes) {
            std::vector<SummaryRow> of_scene;
            std::copy_if(rows.begin(), rows.end(), std::back_inserter(of_scene),
                         [&](const SummaryRow& row) { return row.key.scene == scene; });
            add_panel(chart, of_scene, counts, fmt::format("{}: {}", scene, what), "", y_of);
        }
    };
    if (scenes.empty()) return chart;
    const std::vector<int> once = {0};
    each_scene(
        "wrong pixels, %",
        [](const SummaryRow& row, int) {
            return row.accuracy != nullptr ? 100 * row.accuracy->wrong.fraction() : 0.0;
        },
        once);
    each_scene(
        "memory, MB", [](const SummaryRow& row, int) { return static_cast<double>(row.bytes) * 1e-6; }, once);
    each_scene(
        "build, s", [&](const SummaryRow& row, int n) { return build_s(results, row.key, n); }, threads);
    each_scene(
        "1 tap or ray, ns per pixel",
        [&](const SummaryRow& row, int n) { return lookup_ns(results, row.key, "1 tap", n); }, threads);
    each_scene(
        "3 x 3, ns per pixel",
        [&](const SummaryRow& row, int n) { return lookup_ns(results, row.key, "3x3", n); }, threads);
    return chart;
}

}  // namespace obscura
