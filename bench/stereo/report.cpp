#include "bench/stereo/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "bench/harness/machine.h"
#include "bench/harness/report.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

std::string ms_cell(double ms) {
    return ms > 0 ? fmt::format("{:.3g}", ms) : std::string("-");
}

std::string px_cell(double px) {
    return px >= 0 ? fmt::format("{:.2g}", px) : std::string("-");
}

std::string error_cell(const MapError& error) {
    return fmt::format("{} / {}", px_cell(error.max_px), px_cell(error.rms_px));
}

/// Further lines for the table of the machine.
std::vector<MachineLine> libraries(const StereoResults& results) {
    const auto version = [](const std::string& text) { return text.empty() ? std::string("absent") : text; };
    return {{"CHOLMOD", version(results.cholmod)}, {"Eigen", version(results.eigen)}};
}

void write_passes(Out out, const StereoResults& results) {
    fmt::format_to(
        out,
        "\n### One pass over memory\n\n3 reads and 1 write of as many floats as there are "
        "unknowns, with or without streaming stores, whichever is faster.\n\n| size | threads | ms "
        "| GB/s |\n|---|--:|--:|--:|\n");
    for (const PassRow& row : results.passes)
        fmt::format_to(out, "| {} x {} | {} | {} | {:.1f} |\n", row.width, row.height, row.threads,
                       ms_cell(row.ms), 16e-6 * row.width * row.height / row.ms);
}

void write_methods(Out out, const StereoResults& results) {
    fmt::format_to(
        out,
        "\n## Base case\n\n![chart](stereo.svg)\n\nLeast milliseconds of whole calls. Errors against the "
        "truth in pixels of that size, largest / rms. Ours, but for the cascades, stop by their own "
        "estimates; Eigen's conjugate gradients are stopped by us at the first iteration below 0.05 px and "
        "0.02 px rms. *Again*: the same call when an earlier one left levels (ours) or factor (CHOLMOD, "
        "LDLT). *Made*, *iterated*: parts of the whole call.\n\n| size | method | threads | ms | passes | "
        "again | made | iterated | iterations | error, px | estimate, px | |\n"
        "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|\n");
    for (const StereoRow& row : results.rows) {
        const bool measured = row.whole_ms > 0;
        const bool estimated = row.estimate_max_px >= 0;
        fmt::format_to(out, "| {} x {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", row.width,
                       row.height, row.method, row.threads, ms_cell(row.whole_ms),
                       measured ? fmt::format("{:.0f}", in_passes(results, row, row.whole_ms)) : "-",
                       ms_cell(row.kept_ms), ms_cell(row.setup_ms), ms_cell(row.iterate_ms),
                       row.iterations > 0 ? fmt::format("{}", row.iterations) : "",
                       measured ? error_cell(row.error) : "-",
                       estimated ? error_cell({row.estimate_max_px, row.estimate_rms_px}) : "",
                       row.problem.empty() ? row.note : row.problem);
    }
}

/// Errors of multigrid, iteration by iteration.
void write_iterations(Out out, const StereoResults& results) {
    fmt::format_to(out, "\n### Error after every iteration\n\nLargest / rms, px.\n\n| iterations");
    std::vector<const StereoRow*> columns;
    for (const char* method : {multigrid_name, fmg_name, vcycle_name}) {
        for (const StereoRow& row : results.rows) {
            if (row.method != method || row.curve.empty()) continue;
            const bool first = std::none_of(columns.begin(), columns.end(), [&](const StereoRow* c) {
                return c->method == row.method && c->width == row.width;
            });
            if (first) columns.push_back(&row);
        }
    }
    std::size_t most = 0;
    for (const StereoRow* row : columns) {
        fmt::format_to(out, " | {}, {} x {}", row->method, row->width, row->height);
        most = std::max(most, row->curve.size());
    }
    fmt::format_to(out, " |\n|--:");
    for (std::size_t i = 0; i < columns.size(); ++i)
        fmt::format_to(out, "|--:");
    fmt::format_to(out, "|\n");
    for (std::size_t i = 0; i < most; ++i) {
        fmt::format_to(out, "| {}", i + 1);
        for (const StereoRow* row : columns)
            fmt::format_to(out, " | {}", i < row->curve.size() ? error_cell(row->curve[i].error) : "");
        fmt::format_to(out, " |\n");
    }
}

void write_cases(Out out, const StereoResults& results) {
    if (results.cases.empty()) return;
    fmt::format_to(out,
                   "\n## Hard cases\n\nWhat they are: `bench/stereo/scenes.h`. Multigrid with default "
                   "tolerances, one thread. *Needed*: iterations from which on the true error stays below "
                   "the goal. Errors and estimates: largest / rms, px.\n\n| case | size | sets | needed | "
                   "taken | error | estimate | edited map's error | cascade's error | ms |\n"
                   "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const CaseRow& row : results.cases)
        fmt::format_to(out, "| {} | {} x {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", row.stereo_case,
                       row.width, row.height, row.sets,
                       row.needed < 0 ? "more" : fmt::format("{}", row.needed), row.iterations,
                       error_cell(row.error), error_cell({row.estimate_max_px, row.estimate_rms_px}),
                       error_cell(row.start), error_cell(row.cascade), ms_cell(row.ms));
}

void write_previews(Out out, const StereoResults& results) {
    fmt::format_to(
        out,
        "\n## Previews\n\nThe base case solved at 1:n and brought up by bilateral upsampling; "
        "errors, largest / rms, against the truth at full size. *{}*: the reduced view is edited. "
        "*{}*: made out of the full system, which must be there; that takes the time *made*.\n\n"
        "| size | threads | 1: | system | ms | made | solved | upsampled | share of the full solve "
        "| error, px |\n|---|--:|--:|---|--:|--:|--:|--:|--:|--:|\n",
        sampled_way, summed_way);
    double full_ms = 0;
    for (const PreviewRow& row : results.previews) {
        if (row.way.empty()) full_ms = row.ms;
        fmt::format_to(out, "| {} x {} | {} | {} | {} | {} | {} | {} | {} | {:.0f} % | {} |\n", row.width,
                       row.height, row.threads, row.reduction, row.way.empty() ? "full" : row.way,
                       ms_cell(row.ms), ms_cell(row.build_ms), ms_cell(row.solve_ms),
                       ms_cell(row.upsample_ms), 100 * row.ms / full_ms, error_cell(row.error));
    }
}

void write_truths(Out out, const StereoResults& results) {
    double worst = 0;
    std::string by;
    for (const TruthRow& row : results.truths) {
        worst = std::max(worst, row.residual);
        if (by.find(row.by) == std::string::npos) by += (by.empty() ? "" : "; ") + row.by;
    }
    fmt::format_to(
        out,
        "\n## Truth\n\n{} systems solved in double by: {}. Largest residual of any pixel in any of "
        "them: {:.1e}.\n",
        results.truths.size(), by, worst);
}

std::string quoted(std::string text) {
    std::replace(text.begin(), text.end(), '"', '\'');
    return '"' + text + '"';
}

}  // namespace

const StereoRow* find_row(const StereoResults& results, const StereoRow& like, const std::string& method,
                          int threads) {
    for (const StereoRow& row : results.rows) {
        if (row.width == like.width && row.height == like.height && row.method == method &&
            row.threads == threads)
            return &row;
    }
    return nullptr;
}

double in_passes(const StereoResults& results, const StereoRow& row, double ms) {
    for (const PassRow& pass : results.passes) {
        if (pass.width == row.width && pass.height == row.height && pass.threads == row.threads)
            return ms / pass.ms;
    }
    return 0;
}

std::string stereo_csv(const StereoResults& results) {
    std::string text =
        "width,height,method,threads,whole_ms,passes,kept_ms,setup_ms,iterate_ms,iterations,error_max_px,"
        "error_rms_px,estimate_max_px,estimate_rms_px,note,problem\n";
    for (const StereoRow& row : results.rows)
        fmt::format_to(
            Out(text),
            "{},{},{},{},{:.4f},{:.2f},{:.4f},{:.4f},{:.4f},{},{:.4e},{:.4e},{:.4e},{:.4e},{},{}\n",
            row.width, row.height, quoted(row.method), row.threads, row.whole_ms,
            in_passes(results, row, row.whole_ms), row.kept_ms, row.setup_ms, row.iterate_ms, row.iterations,
            row.error.max_px, row.error.rms_px, row.estimate_max_px, row.estimate_rms_px, quoted(row.note),
            quoted(row.problem));
    return text;
}

std::string stereo_curves_csv(const StereoResults& results) {
    std::string text = "width,height,method,threads,step,ms,passes,error_max_px,error_rms_px\n";
    for (const StereoRow& row : results.rows) {
        for (const CurvePoint& point : row.curve)
            fmt::format_to(Out(text), "{},{},{},{},{},{:.4f},{:.2f},{:.4e},{:.4e}\n", row.width, row.height,
                           quoted(row.method), row.threads, point.step, point.ms,
                           in_passes(results, row, point.ms), point.error.max_px, point.error.rms_px);
    }
    return text;
}

std::string stereo_cases_csv(const StereoResults& results) {
    std::string text =
        "case,width,height,sets,needed,iterations,error_max_px,error_rms_px,estimate_max_px,estimate_rms_px,"
        "start_max_px,start_rms_px,cascade_max_px,cascade_rms_px,ms\n";
    for (const CaseRow& row : results.cases)
        fmt::format_to(Out(text),
                       "{},{},{},{},{},{},{:.4e},{:.4e},{:.4e},{:.4e},{:.4e},{:.4e},{:.4e},{:.4e},{:.4f}\n",
                       quoted(row.stereo_case), row.width, row.height, row.sets, row.needed, row.iterations,
                       row.error.max_px, row.error.rms_px, row.estimate_max_px, row.estimate_rms_px,
                       row.start.max_px, row.start.rms_px, row.cascade.max_px, row.cascade.rms_px, row.ms);
    return text;
}

std::string stereo_markdown(const StereoResults& results, const BenchOptions& options) {
    std::string text = report_head("Stereo bench", "small pictures", options);
    const Out out(text);
    fmt::format_to(out,
                   "Least of up to {} interleaved turns after a warm-up. What is measured, and how: "
                   "bench/README.md.\n\n",
                   options.runs);
    text += stereo_goals_markdown(results);
    text += '\n' + machine_markdown(libraries(results));
    write_passes(out, results);
    write_methods(out, results);
    write_iterations(out, results);
    write_cases(out, results);
    write_previews(out, results);
    write_truths(out, results);
    return text;
}

void write_stereo_report(const StereoResults& results, const BenchOptions& options) {
    write_files(options, {{"stereo.csv", stereo_csv(results)},
                          {"stereo_curves.csv", stereo_curves_csv(results)},
                          {"stereo_cases.csv", results.cases.empty() ? "" : stereo_cases_csv(results)},
                          {"stereo.md", stereo_markdown(results, options)}});
}

}  // namespace obscura
