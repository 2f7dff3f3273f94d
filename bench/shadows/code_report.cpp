#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "bench/harness/panel_chart.h"
#include "bench/harness/report.h"
#include "bench/shadows/code_bench.h"
#include "bench/shadows/report.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

double mb(std::uint64_t bytes) {
    return static_cast<double>(bytes) * 1e-6;
}

/// As many as merge_trials() has.
constexpr std::size_t merge_trial_count = 5;

/// One of Okabe and Ito's colours for each; what is stored by itself is grey or black.
MethodStyle code_style(const std::string& code) {
    static const std::pair<const char*, MethodStyle> styles[] = {
        {dense_code, {"#888888", 1, 2}},    {constant_code, {"#E69F00", 8, 9}},
        {linear_code, {"#D55E00", 10, 11}}, {voxel_code, {"#CC79A7", 12, 13}},
        {"MH", {"#000000", 4, 5}},          {"MMH", {"#56B4E9", 6, 7}},
        {"DAG-MH", {"#0072B2", 14, 15}},    {"DAG-MH, packed", {"#009E73", 6, 7}},
        {"facet", {"#000000", 2, 3}},
    };
    for (const auto& [name, style] : styles) {
        if (code == name) return style;
    }
    return {"#888888", 1, 2};
}

std::string rate_text(double rate) {
    return rate > 0 ? fmt::format("{:.0f}", rate) : "";
}

}  // namespace

std::uint64_t CodeRow::mmh_bytes() const {
    for (const MergeTrial& trial : trials) {
        if (trial.params.count_survivors && trial.params.search_limit != 0) return trial.bytes;
    }
    return 0;
}

const CodeCost* CodeRow::cost(const std::string& code) const {
    const auto found =
        std::find_if(costs.begin(), costs.end(), [&](const CodeCost& cost) { return cost.code == code; });
    return found == costs.end() ? nullptr : &*found;
}

std::string trial_name(const MergeParams& params) {
    if (params.search_limit == 0) return "all";
    return fmt::format("{}{}", params.search_limit, params.count_survivors ? " survivors" : "");
}

std::string cost_csv(const std::vector<CodeRow>& rows) {
    std::string text =
        "scene,triangles,size,code,bytes,build_s,lookups_1,lookups_3x3,lookups_5x5,rounded_texels\n";
    for (const CodeRow& row : rows) {
        for (const CodeCost& c : row.costs) {
            fmt::format_to(Out(text), "{},{},{},\"{}\",{},{:.3f}", row.scene, row.triangles, row.size, c.code,
                           c.bytes, c.build_s);
            for (const double rate : c.lookups)
                text += rate > 0 ? fmt::format(",{:.2f}", rate) : std::string(",");
            fmt::format_to(Out(text), ",{}\n", c.rounded_texels);
        }
    }
    return text;
}

std::string cost_markdown(const std::vector<CodeRow>& rows) {
    std::string text =
        "## All codes\n\n"
        "Bytes of nodes, without a top grid; seconds from triangles to bytes; million lookups a second of "
        "one thread at the pixels of a 1920 x 1080 picture, with kernels of 1, 3 x 3 and 5 x 5 texels and a "
        "top grid of six levels. Scanlines and voxels (bench/peer_codes) are sizes alone. Rounded: texels of "
        "the voxels' map whose depths have no boundary of voxels among them, so that what they store is not "
        "exact.\n\n"
        "| scene | texels | code | MB | /MH | s | 1 | 3x3 | 5x5 | rounded, % |\n"
        "|---|--:|---|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const CodeRow& row : rows) {
        for (const CodeCost& c : row.costs) {
            const double texels = static_cast<double>(row.size) * row.size;
            fmt::format_to(Out(text), "| {} | {} | {} | {:.3f} | {:.3f} |", row.scene, row.size, c.code,
                           mb(c.bytes), static_cast<double>(c.bytes) / static_cast<double>(row.mh_bytes));
            text += c.build_s > 0 ? fmt::format(" {:.2f} |", c.build_s) : std::string(" |");
            for (const double rate : c.lookups)
                text += fmt::format(" {} |", rate_text(rate));
            text += c.code == voxel_code
                        ? fmt::format(" {:.3g} |\n", 100 * static_cast<double>(c.rounded_texels) / texels)
                        : std::string(" |\n");
        }
    }
    return text;
}

PanelChart cost_chart(const std::vector<CodeRow>& rows) {
    PanelChart chart;
    chart.style_of = code_style;
    chart.title = "Memory of one shadow map, by how it is written";
    chart.note = "Texels find depths of their own interval in all but the voxels; both axes logarithmic.";
    chart.x_label = "texels a side";
    chart.y_label = "MB";
    // Dense maps leave the panels soon: else all others would lie on one line.
    chart.x_tics = size_tics() + "\nset xrange [900:80000]\nset yrange [0.02:60]";
    chart.key_strip = true;
    chart.panel_height = 400;
    for (const std::string& scene : distinct(rows, &CodeRow::scene)) {
        std::vector<PanelLine> lines;
        for (const CodeRow& row : rows) {
            if (row.scene != scene) continue;
            for (const CodeCost& c : row.costs) {
                auto line = std::find_if(lines.begin(), lines.end(),
                                         [&](const PanelLine& l) { return l.method == c.code; });
                if (line == lines.end()) line = lines.insert(lines.end(), {c.code, {}});
                line->points.push_back({static_cast<double>(row.size), mb(c.bytes)});
            }
        }
        chart.panels.push_back({scene, {}, std::move(lines)});
    }
    return chart;
}

std::string merge_csv(const std::vector<CodeRow>& rows) {
    std::string text =
        "scene,triangles,size,full,empty,leaf,mh_bytes,build_s,mh_s,search,mmh_bytes,ratio,mmh_full,"
        "mmh_empty,mmh_leaf,merged,interval_percent,distance_percent,full_test_percent,float_bits,mmh_s\n";
    for (const CodeRow& row : rows) {
        for (const MergeTrial& trial : row.trials) {
            fmt::format_to(Out(text), "{},{},{},{},{},{},{},{:.3f},{:.3f},{},{},{:.4f},{},{},{},{},",
                           row.scene, row.triangles, row.size, row.nodes.full, row.nodes.empty,
                           row.nodes.leaf, row.mh_bytes, row.build_s, row.mh_s, trial_name(trial.params),
                           trial.bytes, row.ratio(trial), trial.nodes.full, trial.nodes.empty,
                           trial.nodes.leaf, trial.stats.merged);
            fmt::format_to(Out(text), "{:.2f},{:.2f},{:.2f},{},{:.3f}\n",
                           trial.share(trial.stats.interval_mismatch), trial.share(trial.stats.too_far),
                           trial.share(trial.stats.full_rejected), trial.float_bits ? 1 : 0, trial.encode_s);
        }
    }
    return text;
}

std::string merge_markdown(const std::vector<CodeRow>& rows) {
    std::string text =
        "\n## Merging\n\nMMH over MH (words24), by how many subtrees of equal topology each is compared "
        "with: of all, as the paper counts, of those that were not merged, all.\n\n"
        "| scene | texels | nodes | MH, MB | 100 | 500 | 1000 | 1000 survivors | all |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const CodeRow& row : rows) {
        fmt::format_to(Out(text), "| {} | {} | {} | {:.2f} |", row.scene, row.size,
                       row.nodes.full + row.nodes.empty + row.nodes.leaf,
                       static_cast<double>(row.mh_bytes) * 1e-6);
        for (std::size_t i = 0; i < merge_trial_count; ++i) {
            text += i < row.trials.size() ? fmt::format(" {:.3f} |", row.ratio(row.trials[i])) : " - |";
        }
        text += "\n";
    }
    text +=
        "\n## Pairs\n\nWhat became of the pairs that were compared, 1000 survivors, in percent; the paper's "
        "table 3 has 62 to 67, 0 to 14 and 24 to 36 of those rejected.\n\n"
        "| scene | texels | extremes apart | too far | value by value | merged | s "
        "|\n|---|--:|--:|--:|--:|--:|--:|\n";
    for (const CodeRow& row : rows) {
        for (const MergeTrial& trial : row.trials) {
            if (!trial.params.count_survivors || trial.params.search_limit == 0) continue;
            fmt::format_to(Out(text), "| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.2f} |\n", row.scene,
                           row.size, trial.share(trial.stats.interval_mismatch),
                           trial.share(trial.stats.too_far), trial.share(trial.stats.full_rejected),
                           trial.share(trial.stats.merged), trial.encode_s);
        }
    }
    return text;
}

std::string dag_csv(const std::vector<CodeRow>& rows) {
    std::string text =
        "scene,size,mh_bytes,mmh_bytes,packed,treelet_levels,chunk,dag_bytes,inner_nodes,inner_bytes,"
        "treelets,treelet_bytes,values,chunk_bytes,factors,factor_bytes,dag_s\n";
    for (const CodeRow& row : rows) {
        for (const DagTrial& trial : row.dag_trials) {
            const DagStats& s = trial.stats;
            fmt::format_to(Out(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3f}\n", row.scene,
                           row.size, row.mh_bytes, row.mmh_bytes(), trial.params.packed ? 1 : 0,
                           trial.params.treelet_levels, 1 << trial.params.chunk_log2, trial.bytes,
                           s.inner_nodes, s.inner_bytes, s.treelets, s.treelet_bytes, s.values, s.chunk_bytes,
                           s.factors, s.factor_bytes, trial.encode_s);
        }
    }
    return text;
}

std::string dag_markdown(const std::vector<CodeRow>& rows) {
    std::string text =
        "\n## Graphs\n\nAs the paper has them, with treelets of four levels and chunks of 32; then bytes "
        "over theirs with other treelets and chunks, and packed. MMH: 1000 survivors.\n\n"
        "| scene | texels | DAG, MB | structure | values | /MH | /MMH | 1 level | 2 | 3 | 5 | chunks of 16 | "
        "64 | 128 | packed, 32 | 64 | 128 | with factor, % | bits of one | s |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const CodeRow& row : rows) {
        const DagTrial& first = row.dag_trials.front();
        const auto over = [&](std::uint64_t bytes) {
            return static_cast<double>(first.bytes) / static_cast<double>(bytes);
        };
        fmt::format_to(Out(text), "| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.3f} | {:.3f} |", row.scene,
                       row.size, mb(first.bytes), mb(first.stats.structure_bytes()),
                       mb(first.stats.value_bytes()), over(row.mh_bytes), over(row.mmh_bytes()));
        for (std::size_t i = 1; i < row.dag_trials.size(); ++i)
            fmt::format_to(Out(text), " {:.3f} |", 1 / over(row.dag_trials[i].bytes));
        const auto factors = static_cast<double>(std::max<std::uint64_t>(first.stats.factors, 1));
        fmt::format_to(Out(text), " {:.1f} | {:.1f} | {:.2f} |\n",
                       100 * factors / static_cast<double>(first.stats.values),
                       8 * static_cast<double>(first.stats.factor_bytes) / factors, first.encode_s);
    }
    return text;
}

}  // namespace obscura
