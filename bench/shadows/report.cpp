#include "bench/shadows/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "bench/harness/machine.h"
#include "bench/harness/report.h"
#include "bench/harness/run_times.h"
#include "bench/shadows/summary.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

std::uint64_t total(const MultiresCounts& nodes) {
    return nodes.full + nodes.empty + nodes.leaf;
}

double megabytes(std::int64_t bytes) {
    return static_cast<double>(bytes) * 1e-6;
}

double dense_bytes(int size) {
    return 4.0 * size * static_cast<double>(size);
}

void write_accuracy(Out out, const std::vector<AccuracyRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(
        out,
        "\n## Wrong pixels against exact "
        "rays\n\n![chart](shadows_accuracy.svg)\n\n![chart](shadows_bytes.svg)\n\nOne lookup per pixel, "
        "kernel of one texel, 1920 x 1080 unless quick. Worse, better: pixels that compressed has wrong and "
        "the dense map of that size right, and the reverse. The last columns say why pixels are wrong: see "
        "bench/README.md.\n\n"
        "| scene | map | wrong % | pixels | worse | better | outline | inside | grazing | open | MB | built "
        "in s |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const AccuracyRow& row : rows) {
        if (row.size == 0) continue;  // rays: in the summary
        const auto kind = [&](Wrong k) { return row.wrong.by_kind[static_cast<std::size_t>(k)]; };
        fmt::format_to(out, "| {} | {} | {:.4f} | {} | {} | {} | {} | {} | {} | {} | {:.3f} | {:.2f} |\n",
                       row.scene, method_name(row.method, row.size), 100 * row.wrong.fraction(),
                       row.wrong.wrong, row.has_dense ? fmt::format("{}", row.worse) : "",
                       row.has_dense ? fmt::format("{}", row.better) : "", kind(Wrong::outline),
                       kind(Wrong::interval), kind(Wrong::grazing), kind(Wrong::open), megabytes(row.bytes),
                       row.build_s);
    }
}

std::string auto_text(const SweepRow& row) {
    const std::string size = size_name(row.found);
    if (row.magnification == 1) return "auto, " + size;
    return fmt::format("auto of 1/{:.0f} pixel, {}", 1 / row.magnification, size);
}

void write_sweep(Out out, const std::vector<SweepRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(
        out,
        "\n## Default and exact shadows against exact rays\n\nMethod exact; and trees built for the picture, "
        "one tap per pixel, at the resolution that \"auto\" finds and at 1,048,576. Goal of exact: 0.002 "
        "%.\n\n"
        "| scene | sun, degrees | shadow | wrong % | pixels | shown lit | why | MB | built in s |\n"
        "|---|--:|--:|--:|--:|--:|---|--:|--:|\n");
    struct Share {
        double sum = 0, worst = 0;
        std::size_t rows = 0;
    } of_auto, of_exact;
    for (const SweepRow& row : rows) {
        const bool is_exact = row.method == exact_name;
        const std::string what = is_exact         ? row.method
                                 : row.asked == 0 ? auto_text(row)
                                                  : size_name(row.asked);
        if (!row.problem.empty()) {
            fmt::format_to(out, "| {} | {} | {} | {} |\n", row.scene, row.elevation_deg, what, row.problem);
            continue;
        }
        const double percent = 100 * row.wrong.fraction();
        fmt::format_to(out, "| {} | {} | {} | {:.4f} | {} | {} | {} | {:.1f} | {:.2f} |\n", row.scene,
                       row.elevation_deg, what, percent, row.wrong.wrong, row.wrong.leaks,
                       kinds_text(row.wrong), megabytes(static_cast<std::int64_t>(row.bytes)), row.build_s);
        if (row.asked != 0 || row.magnification != 1) continue;
        Share& share = is_exact ? of_exact : of_auto;
        share.sum += percent;
        share.worst = std::max(share.worst, percent);
        ++share.rows;
    }
    for (const auto& [what, share] : {std::pair{"At auto", of_auto}, std::pair{"Exact", of_exact}}) {
        if (share.rows > 0)
            fmt::format_to(out, "\n{}: {:.5f} % on average, {:.5f} % at worst.\n", what,
                           share.sum / static_cast<double>(share.rows), share.worst);
    }
}

void write_times(Out out, const std::vector<TimeRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(
        out,
        "\n## Lookups and builds\n\n![chart](shadows_lookups.svg)\n\nMilliseconds for all pixels that "
        "face the light, median (least to greatest); millions of lookups per second and "
        "thread.\n\n| scene | method | job | threads | ms | M/s per thread | MB |\n"
        "|---|---|---|--:|--:|--:|--:|\n");
    for (const TimeRow& row : rows) {
        fmt::format_to(out, "| {} | {} | {} | {} | {} | {} | {:.2f} |\n", row.scene,
                       method_name(row.method, row.size), row.job, row.threads,
                       row.problem.empty() ? range_text(row.runs_ms, 2) : row.problem,
                       row.rate() > 0 ? fmt::format("**{:.1f}**", row.rate()) : "", megabytes(row.bytes));
    }
}

/// Rates of trees beside Embree's packets and the largest dense map; naive kernels beside shared ones.
void write_ratios(Out out, const std::vector<TimeRow>& rows) {
    int dense = 0;
    for (const TimeRow& row : rows)
        dense = row.method == dense_name ? std::max(dense, row.size) : dense;
    const auto is_kernel = [](const TimeRow& row) {
        return row.job.rfind("1 tap", 0) == 0 || row.job.rfind("3x3", 0) == 0 || row.job.rfind("5x5", 0) == 0;
    };
    if (dense == 0) return;
    fmt::format_to(
        out,
        "\n## Lookups in trees against peers\n\nRatios of rates: above 1 the tree is faster. Dense: {} "
        "with the same kernel. Naive: every tap from the root. From surfaces to visibility. "
        "Trees have the default top grid but where a job says so; hierarchical kernels are as large as the "
        "pixel on the map.\n\n| scene | map | threads | job | M/s per thread | / Embree packets | / dense "
        "| / naive |\n|---|---|--:|---|--:|--:|--:|--:|\n",
        size_name(dense));
    for (const TimeRow& row : rows) {
        const bool naive = row.job.find("naive") != std::string::npos;
        if (row.method != compressed_name || !is_kernel(row) || naive || row.runs_ms.empty()) continue;
        const bool hierarchical = row.job.find("hierarchical") != std::string::npos;
        const std::string kernel = row.job.substr(0, row.job.find(','));
        const auto ratio = [&](const std::string& method, int size, const std::string& job) {
            const TimeRow* peer = find_time(rows, {row.scene, method, size}, job, row.threads);
            return peer != nullptr ? fmt::format("{:.2f}", row.rate() / peer->rate()) : std::string("-");
        };
        fmt::format_to(out, "| {} | {} | {} | {} | {:.1f} | {} | {} | {} |\n", row.scene, size_name(row.size),
                       row.threads, row.job, row.rate(), ratio(embree_name, 0, "packets of 16 rays"),
                       ratio(dense_name, dense, kernel),
                       hierarchical ? "-" : ratio(compressed_name, row.size, kernel + ", naive"));
    }
}

/// Builds of trees against ten dual-depth maps of the best peer.
void write_build_budget(Out out, const std::vector<TimeRow>& rows) {
    fmt::format_to(
        out,
        "\n## Building trees against ten dual-depth maps\n\nThe peers' time for first and second "
        "depth (one run, see the raster bench), times ten, over the tree's: above 1 the tree is "
        "faster.\n\n| scene | threads | best peer | its map | ms | tree | built in ms | ten maps / tree "
        "|\n|---|--:|---|--:|--:|--:|--:|--:|\n");
    for (const TimeRow& row : rows) {
        if (row.method != compressed_name || row.job != "build" || row.runs_ms.empty()) continue;
        const TimeRow* best = nullptr;
        for (const TimeRow& peer : rows) {
            const bool fits = peer.scene == row.scene && peer.threads == row.threads &&
                              peer.job.rfind("dual depth", 0) == 0 && peer.method != our_name;
            if (!fits || peer.runs_ms.empty()) continue;
            if (best == nullptr || peer.runs_ms[0] < best->runs_ms[0]) best = &peer;
        }
        if (best == nullptr) continue;
        fmt::format_to(out, "| {} | {} | {} | {} | {:.0f} | {} | {:.0f} | **{:.2f}** |\n", row.scene,
                       row.threads, best->method, size_name(best->size), best->runs_ms[0],
                       size_name(row.size), median(row.runs_ms), 10 * best->runs_ms[0] / median(row.runs_ms));
    }
}

void write_steps(Out out, const std::vector<AccuracyRow>& rows) {
    bool titled = false;
    for (const AccuracyRow& row : rows) {
        if (row.naive_steps <= 0) continue;
        if (!titled) {
            fmt::format_to(
                out,
                "\n## Traversal steps\n\nNodes visited per pixel for a kernel of 5 x 5: every tap from "
                "the root, and shared. (Between neighbouring pixels lookups share more still.)\n\n"
                "| scene | map | naive | shared | ratio |\n|---|---|--:|--:|--:|\n");
        }
        titled = true;
        fmt::format_to(out, "| {} | {} | {:.1f} | {:.1f} | {:.1f} |\n", row.scene, size_name(row.size),
                       row.naive_steps, row.shared_steps, row.naive_steps / std::max(row.shared_steps, 1e-9));
    }
}

void write_trees(Out out, const std::vector<SizeRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(
        out,
        "\n## Trees against dense maps\n\n![chart](shadows_trees.svg)\n\nBytes in words with 24-bit offsets; "
        "of dense: of four bytes per texel. Growth: against half the size. Peak: resident memory above what "
        "was there before the build.\n\n"
        "| scene | map | nodes | MB | % of dense | growth | 16-bit words | 16-bit bytes | build s | growth | "
        "encode s | texels rasterized | covers | meshes | peak MiB |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    const SizeRow* before = nullptr;
    for (const SizeRow& row : rows) {
        if (!row.problem.empty()) {
            fmt::format_to(out, "| {} | {} | {} |||||||||||||\n", row.scene, size_name(row.size),
                           row.problem);
            before = nullptr;
            continue;
        }
        const bool follows = before != nullptr && before->scene == row.scene && before->size * 2 == row.size;
        const auto growth = [&](double now, double then) {
            return follows && then > 0 ? fmt::format("{:.2f}", now / then) : std::string();
        };
        fmt::format_to(
            out,
            "| {} | {} | {} | {:.3f} | {:.5f} | {} | {:.3f} | {:.3f} | {:.2f} | {} | {:.2f} | {} | {} | {} | "
            "{:.0f} |\n",
            row.scene, size_name(row.size), total(row.nodes), megabytes(row.words24),
            100 * static_cast<double>(row.words24) / dense_bytes(row.size),
            growth(static_cast<double>(row.words24), follows ? static_cast<double>(before->words24) : 0),
            megabytes(row.words16), megabytes(row.bytes16), row.build_s,
            growth(row.build_s, follows ? before->build_s : 0), row.encode_s, row.stats.texels_rasterized,
            row.stats.certified_cover, row.stats.certified_mesh,
            static_cast<double>(row.peak_bytes) / (1 << 20));
        before = &row;
    }
}

void write_directions(Out out, const std::vector<DirectionRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(out,
                   "\n## Top-down against bottom-up\n\nBoth from the same intervals, one thread.\n\n"
                   "| scene | map | bottom-up kB | top-down kB | ratio | bottom-up s | top-down s | ratio |\n"
                   "|---|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const DirectionRow& row : rows) {
        fmt::format_to(out, "| {} | {} | {:.1f} | {:.1f} | {:.3f} | {:.3f} | {:.3f} | {:.1f} |\n", row.scene,
                       size_name(row.size), static_cast<double>(row.bottom_up_bytes) * 1e-3,
                       static_cast<double>(row.top_down_bytes) * 1e-3,
                       static_cast<double>(row.top_down_bytes) / static_cast<double>(row.bottom_up_bytes),
                       row.bottom_up_s, row.top_down_s, row.top_down_s / row.bottom_up_s);
    }
}

}  // namespace

std::string size_name(int size) {
    if (size >= 1 << 20 && size % (1 << 20) == 0) return fmt::format("{}M", size >> 20);
    if (size >= 1 << 10 && size % (1 << 10) == 0) return fmt::format("{}k", size >> 10);
    return fmt::format("{}", size);
}

const TimeRow* find_time(const std::vector<TimeRow>& rows, const MethodKey& of, const std::string& job,
                         int threads) {
    for (const TimeRow& row : rows) {
        const bool fits = row.scene == of.scene && row.method == of.method && row.size == of.size;
        if (fits && row.threads == threads && row.job == job && !row.runs_ms.empty()) return &row;
    }
    return nullptr;
}

std::string method_name(const std::string& method, int size) {
    return size == 0 ? method : fmt::format("{} {}", method, size_name(size));
}

std::string accuracy_csv(const std::vector<AccuracyRow>& rows) {
    std::string text =
        "scene,triangles,method,size,bytes,build_s,covered,facing,wrong,wrong_percent,leaks,open,grazing,"
        "outline,inside,worse,better,naive_steps,shared_steps\n";
    for (const AccuracyRow& row : rows) {
        const WrongPixels& w = row.wrong;
        const auto kind = [&](std::size_t k) {  // rays are not judged by kind
            return row.size > 0 ? fmt::format("{}", w.by_kind[k]) : std::string();
        };
        fmt::format_to(Out(text),
                       "{},{},{},{},{},{:.3f},{},{},{},{:.6f},{},{},{},{},{},{},{},{:.2f},{:.2f}\n",
                       row.scene, row.triangles, row.method, row.size, row.bytes, row.build_s, w.covered,
                       w.facing, w.wrong, 100 * w.fraction(), w.leaks, kind(0), kind(1), kind(2), kind(3),
                       row.has_dense ? fmt::format("{}", row.worse) : "",
                       row.has_dense ? fmt::format("{}", row.better) : "", row.naive_steps, row.shared_steps);
    }
    return text;
}

std::string sweep_csv(const std::vector<SweepRow>& rows) {
    std::string text =
        "scene,triangles,elevation_deg,method,asked,magnification,found,bytes,build_s,covered,wrong,"
        "wrong_percent,leaks,open,grazing,outline,inside,off,edge,beside,unexplained,problem\n";
    for (const SweepRow& row : rows) {
        const WrongPixels& w = row.wrong;
        fmt::format_to(Out(text), "{},{},{},{},{},{},{},{},{:.3f},{},{},{:.6f},{},", row.scene, row.triangles,
                       row.elevation_deg, row.method, row.asked, row.magnification, row.found, row.bytes,
                       row.build_s, w.covered, w.wrong, 100 * w.fraction(), w.leaks);
        for (const std::size_t pixels : w.by_kind)
            fmt::format_to(Out(text), "{},", pixels);
        text += row.problem.empty() ? "\n" : "left out\n";
    }
    return text;
}

std::string times_csv(const std::vector<TimeRow>& rows) {
    std::string text =
        "scene,triangles,method,size,job,threads,runs,median_ms,min_ms,max_ms,lookups,"
        "million_per_s_per_thread,bytes,version,problem\n";
    for (const TimeRow& row : rows) {
        fmt::format_to(Out(text), "{},{},{},{},\"{}\",{},{},", row.scene, row.triangles, row.method, row.size,
                       row.job, row.threads, row.runs_ms.size());
        text += range_fields(row.runs_ms);
        fmt::format_to(Out(text), "{},{:.3f},{},{},\"{}\"\n", row.lookups, row.rate(), row.bytes, row.version,
                       row.problem);
    }
    return text;
}

std::string trees_csv(const std::vector<SizeRow>& rows) {
    std::string text =
        "scene,triangles,size,full,empty,leaf,words24_bytes,words16_bytes,bytes16_bytes,build_s,encode_s,"
        "nodes_visited,certified_cover,certified_mesh,texels_rasterized,list_operations,peak_bytes,problem\n";
    for (const SizeRow& row : rows) {
        const BuildStats& s = row.stats;
        fmt::format_to(Out(text), "{},{},{},{},{},{},{},{},{},{:.4f},{:.4f},{},{},{},{},{},{},\"{}\"\n",
                       row.scene, row.triangles, row.size, row.nodes.full, row.nodes.empty, row.nodes.leaf,
                       row.words24, row.words16, row.bytes16, row.build_s, row.encode_s, s.nodes_visited,
                       s.certified_cover, s.certified_mesh, s.texels_rasterized, s.list_operations,
                       row.peak_bytes, row.problem);
    }
    return text;
}

std::string directions_csv(const std::vector<DirectionRow>& rows) {
    std::string text =
        "scene,size,bottom_up_nodes,top_down_nodes,bottom_up_bytes,top_down_bytes,bottom_up_s,top_down_s\n";
    for (const DirectionRow& row : rows) {
        fmt::format_to(Out(text), "{},{},{},{},{},{},{:.4f},{:.4f}\n", row.scene, row.size,
                       total(row.bottom_up), total(row.top_down), row.bottom_up_bytes, row.top_down_bytes,
                       row.bottom_up_s, row.top_down_s);
    }
    return text;
}

std::string shadow_markdown(const ShadowResults& results, const BenchOptions& options) {
    std::string text = report_head("Shadow bench", "small maps of a small scene", options);
    const Out out(text);
    fmt::format_to(out,
                   "Medians of up to {} interleaved runs. What is measured, and how: bench/README.md.\n\n",
                   options.runs);
    text += summary_markdown(results);
    text += '\n' + machine_markdown({});
    write_accuracy(out, results.accuracy);
    write_sweep(out, results.sweep);
    write_ratios(out, results.times);
    if (!results.times.empty()) write_build_budget(out, results.times);
    write_times(out, results.times);
    write_steps(out, results.accuracy);
    write_trees(out, results.sizes);
    write_directions(out, results.directions);
    return text;
}

void write_shadow_report(const ShadowResults& results, const BenchOptions& options) {
    // A table without rows leaves the file of an earlier run alone.
    const auto unless_empty = [](const auto& rows, auto csv) { return rows.empty() ? "" : csv(rows); };
    write_files(options, {{"shadows_accuracy.csv", unless_empty(results.accuracy, accuracy_csv)},
                          {"shadows_wrong.csv", unless_empty(results.sweep, sweep_csv)},
                          {"shadows_times.csv", unless_empty(results.times, times_csv)},
                          {"shadows_trees.csv", unless_empty(results.sizes, trees_csv)},
                          {"shadows_directions.csv", unless_empty(results.directions, directions_csv)},
                          {"shadows.md", shadow_markdown(results, options)}});
}

}  // namespace obscura
