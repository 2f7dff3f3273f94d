#include "bench/raster/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "bench/harness/machine.h"
#include "bench/harness/report.h"
#include "bench/harness/run_times.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

/// Quotes a CSV field where it needs it (RFC 4180).
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    return quoted + '"';
}

std::string ratio_text(std::optional<double> ratio) {
    return ratio ? fmt::format("{:.2f}", *ratio) : "-";
}

void write_contestants(Out out, const std::vector<BenchRow>& rows) {
    fmt::format_to(out, "\n## Who took part\n\n");
    std::vector<std::string> seen;
    for (const BenchRow& row : rows) {
        const std::string text =
            fmt::format("{}: {}", row.contestant, row.problem.empty() ? row.version : row.problem);
        if (std::find(seen.begin(), seen.end(), text) != seen.end()) continue;
        seen.push_back(text);
        fmt::format_to(out, "- {}\n", text);
    }
}

/// The line that says how far ahead of the best peer ours is.
void write_headline(Out out, const std::vector<BenchRow>& rows, const BenchOptions& options) {
    fmt::format_to(
        out,
        "\n## Against the best peer\n\nMilliseconds, median (least to greatest). The best peer is the "
        "fastest that does the whole work.\n\n"
        "| work | scene | threads | Obscura | best peer | its time | peer / Obscura |\n"
        "|---|---|--:|--:|---|--:|--:|\n");
    const auto ours = [](const BenchRow& row) { return row.contestant == our_name; };
    const auto peers = [](const BenchRow& row) { return row.contestant != our_name; };
    for (const Workload workload : all_workloads) {
        for (const std::string& scene : distinct(rows, &BenchRow::scene)) {
            for (const int threads : options.threads) {
                const BenchRow* our = fastest(rows, scene, workload, threads, ours);
                const BenchRow* peer = fastest(rows, scene, workload, threads, peers);
                if (our == nullptr && peer == nullptr) continue;
                fmt::format_to(out, "| {} | {} | {} | {} | {} | {} | **{}** |\n", workload_name(workload),
                               scene, threads, our != nullptr ? range_text(our->runs_ms, 1) : "-",
                               peer != nullptr ? fmt::format("{}, {}", peer->contestant, peer->method) : "-",
                               peer != nullptr ? range_text(peer->runs_ms, 1) : "-",
                               peer != nullptr ? ratio_text(ratio_to_ours(rows, *peer)) : "-");
            }
        }
    }
}

void write_times(Out out, const std::vector<BenchRow>& rows, Workload workload) {
    bool titled = false;
    for (const BenchRow& row : rows) {
        if (row.workload != workload || row.runs_ms.empty()) continue;
        if (!titled) {
            fmt::format_to(out,
                           "\n## {}\n\n![chart](raster_{}.svg)\n\n"
                           "| scene | triangles | who | how | threads | ms | / Obscura | prepared in ms (not "
                           "counted) |\n"
                           "|---|--:|---|---|--:|--:|--:|--:|\n",
                           workload_title(row), workload_file_name(workload));
            titled = true;
        }
        fmt::format_to(out, "| {} | {} | {} | {}{} | {} | {} | {} | {:.1f} |\n", row.scene, row.triangles,
                       row.contestant, row.method, row.same_work ? "" : " *", row.threads,
                       range_text(row.runs_ms, 1), ratio_text(ratio_to_ours(rows, row)), row.prepare_ms);
    }
    if (titled) fmt::format_to(out, "\n\\* not the whole work, or another result: see bench/README.md.\n");
}

void write_agreement(Out out, const std::vector<BenchRow>& rows) {
    fmt::format_to(
        out,
        "\n## Do they compute the same?\n\nFraction of texels (pixels) covered, mean depth of the first "
        "and second layer (frames: mean luminance), and the fraction of texels whose first depth is off "
        "the first contestant's by more than 1e-5 of the range: of all, and away from silhouettes.\n\n"
        "| work | scene | who | how | threads | covered | mean 1 | mean 2 | off | off inside |\n"
        "|---|---|---|---|--:|--:|--:|--:|--:|--:|\n");
    for (const BenchRow& row : rows) {
        if (!row.agreement) continue;
        const Agreement& a = *row.agreement;
        const bool depth = !is_frame(row.workload);
        fmt::format_to(
            out, "| {} | {} | {} | {} | {} | {:.5f} | {:.5f} | {} | {} | {} |\n", workload_name(row.workload),
            row.scene, row.contestant, row.method, row.threads, a.covered, a.mean_first,
            row.workload == Workload::dual_depth ? fmt::format("{:.5f}", a.mean_second) : "",
            depth ? fmt::format("{:.2e}", a.wrong) : "", depth ? fmt::format("{:.2e}", a.wrong_inside) : "");
    }
}

}  // namespace

std::string workload_title(const BenchRow& row) {
    const std::string size = fmt::format(", {} x {}", row.width, row.height);
    switch (row.workload) {
        case Workload::depth:
            return "Nearest depth per texel of a light view" + size;
        case Workload::dual_depth:
            return "First and second depth per texel of a light view" + size;
        case Workload::frame:
            return "Shaded frame after the light has moved" + size;
        case Workload::static_frame:
            return "Shaded frame after only the camera has moved" + size;
        case Workload::shadow_map:
        case Workload::lookup:
            break;
    }
    return {};
}

const BenchRow* fastest(const std::vector<BenchRow>& rows, const std::string& scene, Workload workload,
                        int threads, const std::function<bool(const BenchRow&)>& take) {
    const BenchRow* best = nullptr;
    for (const BenchRow& row : rows) {
        const bool fits = row.scene == scene && row.workload == workload && row.threads == threads;
        if (!fits || !row.same_work || row.runs_ms.empty() || !take(row)) continue;
        if (best == nullptr || median(row.runs_ms) < median(best->runs_ms)) best = &row;
    }
    return best;
}

std::optional<double> ratio_to_ours(const std::vector<BenchRow>& rows, const BenchRow& row) {
    const BenchRow* ours = fastest(rows, row.scene, row.workload, row.threads,
                                   [](const BenchRow& r) { return r.contestant == our_name; });
    if (ours == nullptr || row.runs_ms.empty()) return std::nullopt;
    return median(row.runs_ms) / median(ours->runs_ms);
}

std::string summary_csv(const std::vector<BenchRow>& rows) {
    std::string text =
        "scene,triangles,workload,width,height,contestant,method,whole_work,threads,runs,median_ms,min_ms,"
        "max_ms,ratio_to_obscura,prepare_ms,prepare_mib,covered,mean_first,mean_second,off,off_inside,"
        "version,problem\n";
    const Out out(text);
    for (const BenchRow& row : rows) {
        fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},", field(row.scene), row.triangles,
                       workload_name(row.workload), row.width, row.height, field(row.contestant),
                       field(row.method), row.same_work ? 1 : 0, row.threads, row.runs_ms.size());
        text += range_fields(row.runs_ms);
        const std::optional<double> ratio = ratio_to_ours(rows, row);
        fmt::format_to(out, "{},{:.3f},{:.2f},", ratio ? fmt::format("{:.4f}", *ratio) : "", row.prepare_ms,
                       row.prepare_mib);
        if (row.agreement) {
            const Agreement& a = *row.agreement;
            const auto known = [](double v) { return v < 0 ? std::string() : fmt::format("{:.3e}", v); };
            fmt::format_to(out, "{:.6f},{:.6f},{:.6f},{},{},", a.covered, a.mean_first, a.mean_second,
                           known(a.wrong), known(a.wrong_inside));
        } else {
            fmt::format_to(out, ",,,,,");
        }
        fmt::format_to(out, "{},{}\n", field(row.version), field(row.problem));
    }
    return text;
}

std::string runs_csv(const std::vector<BenchRow>& rows) {
    std::string text = "scene,workload,contestant,method,threads,run,ms\n";
    const Out out(text);
    for (const BenchRow& row : rows) {
        for (std::size_t run = 0; run < row.runs_ms.size(); ++run) {
            fmt::format_to(out, "{},{},{},{},{},{},{:.4f}\n", field(row.scene), workload_name(row.workload),
                           field(row.contestant), field(row.method), row.threads, run + 1, row.runs_ms[run]);
        }
    }
    return text;
}

std::string report_markdown(const std::vector<BenchRow>& rows, const BenchOptions& options) {
    std::string text = report_head("Raster bench", "small pictures", options);
    const Out out(text);
    fmt::format_to(out,
                   "Medians of {} interleaved runs. What is measured, and what each peer is asked to do: "
                   "bench/README.md.\n\n",
                   options.runs);
    text += machine_markdown({});
    write_contestants(out, rows);
    write_headline(out, rows, options);
    for (const Workload workload : all_workloads)
        write_times(out, rows, workload);
    write_agreement(out, rows);
    return text;
}

void write_report(const std::vector<BenchRow>& rows, const BenchOptions& options) {
    make_output_folder(options);
    write_files(options, {{"raster.csv", summary_csv(rows)},
                          {"raster_runs.csv", runs_csv(rows)},
                          {"raster.md", report_markdown(rows, options)}});
}

}  // namespace obscura
