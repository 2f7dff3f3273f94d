#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "bench/harness/gnuplot.h"
#include "bench/harness/machine.h"
#include "bench/harness/panel_chart.h"
#include "bench/harness/report.h"
#include "bench/harness/run_times.h"
#include "bench/shadows/exact_bench.h"
#include "bench/shadows/report.h"
#include "core/error.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

double per_sample(std::int64_t work, const ExactRow& row) {
    return static_cast<double>(work) / static_cast<double>(std::max<std::int64_t>(row.ours.asked, 1));
}

double lit_percent(const ExactFindings& findings) {
    return 100.0 * static_cast<double>(findings.lit) /
           static_cast<double>(std::max<std::int64_t>(findings.asked, 1));
}

/// Time of both methods against `x_of`, a panel per thread count.
PanelChart time_chart(const std::vector<ExactRow>& rows, ExactSeries series,
                      const std::function<double(const ExactRow&)>& x_of) {
    PanelChart chart;
    chart.style_of = shadow_style;
    chart.y_label = "ms";
    chart.key = "top left";
    chart.x_tics = "set format x '%g'";
    for (const int threads : thread_counts(rows)) {
        PanelLine exact{exact_name, {}}, rays{embree_name, {}};
        for (const ExactRow& row : rows) {
            if (row.series != series || row.threads != threads || row.ours_ms() <= 0) continue;
            exact.points.push_back({x_of(row), row.ours_ms()});
            if (row.rays_ms() > 0) rays.points.push_back({x_of(row), row.rays_ms()});
        }
        if (exact.points.empty()) continue;
        Panel panel{threads_text(threads), {}, {}};
        for (PanelLine& line : panel.lines = {exact, rays}) {
            std::sort(line.points.begin(), line.points.end(),
                      [](const PanelPoint& a, const PanelPoint& b) { return a.x < b.x; });
        }
        if (rays.points.empty()) panel.lines.pop_back();
        chart.panels.push_back(std::move(panel));
    }
    return chart;
}

PanelChart error_chart(const std::vector<ErrorTimeRow>& rows) {
    PanelChart chart;
    chart.style_of = shadow_style;
    chart.title = "Wrong shadows against the time that a picture's shadows take";
    chart.note =
        "Building and one lookup per pixel of 1920 x 1080, all threads. No wrong pixel stands as half of "
        "one.";
    chart.x_label = "seconds";
    chart.y_label = "wrong pixels, %";
    chart.x_tics = "set format x '%g'";
    chart.one_key = true;
    for (const std::string& scene : distinct(rows, &ErrorTimeRow::scene)) {
        Panel panel{scene, {}, {}};
        for (const ErrorTimeRow& row : rows) {
            if (row.scene != scene) continue;
            if (panel.lines.empty() || panel.lines.back().method != row.method)
                panel.lines.push_back({row.method, {}});
            const double wrong = std::max(static_cast<double>(row.wrong), 0.5);
            panel.lines.back().points.push_back(
                {row.build_s + row.lookup_s, 100 * wrong / static_cast<double>(row.covered)});
        }
        chart.panels.push_back(std::move(panel));
    }
    return chart;
}

std::string size_text(const ErrorTimeRow& row) {
    if (row.method != compressed_name) return method_name(row.method, row.size);
    return row.size == 0 ? fmt::format("{} auto, {}", row.method, size_name(row.found))
                         : method_name(row.method, row.size);
}

}  // namespace

std::string exact_csv(const std::vector<ExactRow>& rows) {
    std::string text =
        "scene,series,triangles,lights,width,height,samples_per_pixel,threads,covered,samples,groups,"
        "triangles_tested,exact_lit_percent,embree_lit_percent,order_median_ms,order_min_ms,order_max_ms,"
        "lookup_median_ms,lookup_min_ms,lookup_max_ms,hierarchy_median_ms,hierarchy_min_ms,hierarchy_max_ms,"
        "packets_median_ms,packets_min_ms,packets_max_ms,ratio,problem\n";
    for (const ExactRow& row : rows) {
        fmt::format_to(Out(text), "{},{},{},{},{},{},{},{},{},{},{},{},{:.4f},{:.4f},", row.scene,
                       series_name(row.series), row.triangles, row.lights, row.picture.width,
                       row.picture.height, row.samples, row.threads, row.covered, row.ours.asked,
                       row.ours.groups, row.ours.triangles, lit_percent(row.ours), lit_percent(row.rays));
        for (const auto* runs : {&row.order_ms, &row.lookup_ms, &row.hierarchy_ms, &row.packets_ms})
            text += range_fields(*runs);
        fmt::format_to(Out(text), "{:.3f},\"{}\"\n", row.ratio(), row.problem);
    }
    return text;
}

std::string error_time_csv(const std::vector<ErrorTimeRow>& rows) {
    std::string text = "scene,triangles,method,size,found,build_s,lookup_s,wrong,covered,wrong_percent\n";
    for (const ErrorTimeRow& row : rows) {
        fmt::format_to(Out(text), "{},{},{},{},{},{:.4f},{:.4f},{},{},{:.6f}\n", row.scene, row.triangles,
                       row.method, row.size, row.found, row.build_s, row.lookup_s, row.wrong, row.covered,
                       100 * static_cast<double>(row.wrong) / static_cast<double>(row.covered));
    }
    return text;
}

std::string exact_markdown(const std::vector<ExactRow>& rows, const std::vector<ErrorTimeRow>& errors) {
    std::string text;
    const Out out(text);
    if (!rows.empty()) {
        fmt::format_to(
            out,
            "\n## One frame's shadows, exact or by rays\n\n![chart](shadows_exact_samples.svg)\n\n"
            "![chart](shadows_exact_triangles.svg)\n\nMedians, milliseconds. Order: putting casters in "
            "order; hierarchy: Embree's. Samples: pairs of a sample and a light that are looked up, by both. "
            "Groups, triangles: that exact shadows look at, per hundred samples. Lit: of the samples, by "
            "each. Ratio: above 1 exact is faster.\n\n| scene | triangles | lights | picture | per pixel | "
            "threads | samples | groups | triangles | lit %, exact | by rays | order | lookups | hierarchy | "
            "packets | ratio |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    }
    for (const ExactRow& row : rows) {
        if (!row.problem.empty()) {
            fmt::format_to(out, "| {} | {} |\n", row.scene, row.problem);
            continue;
        }
        const auto ms = [](const std::vector<double>& runs) {
            return runs.empty() ? std::string("-") : fmt::format("{:.1f}", median(runs));
        };
        fmt::format_to(
            out,
            "| {} | {} | {} | {} x {} | {} | {} | {} | {:.1f} | {:.1f} | {:.3f} | {:.3f} | {} | {} "
            "| {} | {} | **{:.2f}** |\n",
            row.scene, row.triangles, row.lights, row.picture.width, row.picture.height, row.samples,
            row.threads, row.ours.asked, 100 * per_sample(row.ours.groups, row),
            100 * per_sample(row.ours.triangles, row), lit_percent(row.ours), lit_percent(row.rays),
            ms(row.order_ms), ms(row.lookup_ms), ms(row.hierarchy_ms), ms(row.packets_ms), row.ratio());
    }
    if (errors.empty()) return text;
    fmt::format_to(
        out,
        "\n## Error against time\n\n![chart](shadows_error_time.svg)\n\n| scene | method | build s | "
        "lookups s | wrong | % |\n|---|---|--:|--:|--:|--:|\n");
    for (const ErrorTimeRow& row : errors) {
        fmt::format_to(out, "| {} | {} | {:.3f} | {:.3f} | {} | {:.5f} |\n", row.scene, size_text(row),
                       row.build_s, row.lookup_s, row.wrong,
                       100 * static_cast<double>(row.wrong) / static_cast<double>(row.covered));
    }
    return text;
}

void write_exact_report(const std::vector<ExactRow>& rows, const std::vector<ErrorTimeRow>& errors,
                        const BenchOptions& options) {
    std::string page = report_head("Exact shadows", "small pictures of small scenes", options);
    page += machine_markdown({}) + exact_markdown(rows, errors);
    write_files(options, {{"shadows_exact.csv", rows.empty() ? "" : exact_csv(rows)},
                          {"shadows_error_time.csv", errors.empty() ? "" : error_time_csv(errors)},
                          {"shadows_exact.md", page}});
    if (!can_draw(options)) return;
    const auto draw = [&](PanelChart chart, const char* title, const char* x_label, const char* file) {
        if (chart.panels.empty()) return;
        chart.title = title;
        chart.x_label = x_label;
        chart.note =
            "Exact: order and lookups. Embree: hierarchy and packets of 16 rays. Both axes logarithmic.";
        run_gnuplot(panel_script(chart), options.out / file);
    };
    draw(time_chart(rows, ExactSeries::samples,
                    [](const ExactRow& row) { return static_cast<double>(row.ours.asked); }),
         "Shadows of one frame against its samples", "samples that are looked up",
         "shadows_exact_samples.svg");
    draw(time_chart(rows, ExactSeries::triangles,
                    [](const ExactRow& row) { return static_cast<double>(row.triangles); }),
         "Shadows of one frame against the scene's triangles", "triangles", "shadows_exact_triangles.svg");
    const PanelChart error = error_chart(errors);
    if (!error.panels.empty()) run_gnuplot(panel_script(error), options.out / "shadows_error_time.svg");
}

int bench_exact(const BenchOptions& options) {
    std::vector<ExactRow> rows;
    const std::vector<ExactSubject> subjects = exact_subjects(options);
    check_chosen(!subjects.empty(), options);
    // Their workers must be forked before this process starts threads.
    for (const ExactSubject& subject : subjects) {
        for (ExactRow& row : measure_exact(subject, options))
            rows.push_back(std::move(row));
    }
    std::vector<ErrorTimeRow> errors;
#ifdef OBSCURA_HAS_EMBREE
    const ShadowBenchPlan plan = shadow_bench_plan(options.quick);
    for (const ShadowRecipe& recipe : shadow_recipes(options.data, options.quick)) {
        const bool charted = recipe.name == "city" || recipe.name == "vienna_west";
        if (!charted || recipe.name.find(options.scene) == std::string::npos) continue;
        for (ErrorTimeRow& row : measure_error_times(recipe, plan, options))
            errors.push_back(std::move(row));
    }
#endif
    write_exact_report(rows, errors, options);
    const bool failed =
        std::any_of(rows.begin(), rows.end(), [](const ExactRow& row) { return !row.problem.empty(); });
    return static_cast<int>(failed ? ExitCode::internal : ExitCode::ok);
}

}  // namespace obscura
