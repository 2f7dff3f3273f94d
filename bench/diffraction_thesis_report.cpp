// The thesis's tables and figures beside ours, as ratios.

#include <fmt/format.h>

#include <iterator>

#include "bench/diffraction_report.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

/// Table 3.1: quads at 256, 512, 1024, 2048, 4096.
struct PrintedCounts {
    const char* aperture;
    int size;
    int quads;
};
constexpr PrintedCounts printed_counts[] = {
    {"box", 256, 40},        {"box", 512, 40},         {"box", 1024, 40},        {"box", 2048, 617},
    {"box", 4096, 617},      {"circle", 256, 109},     {"circle", 512, 227},     {"circle", 1024, 440},
    {"circle", 2048, 981},   {"circle", 4096, 1976},   {"heptagon", 256, 176},   {"heptagon", 512, 389},
    {"heptagon", 1024, 730}, {"heptagon", 2048, 1613}, {"heptagon", 4096, 2996}, {"whirl", 256, 303},
    {"whirl", 512, 647},     {"whirl", 1024, 1358},    {"whirl", 2048, 2673},    {"whirl", 4096, 5278},
};

void write_quads(Out out, const std::vector<QuadRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(
        out,
        "\n### Quads (Table 3.1)\n\nCounts depend on how the shape lies on the grid, which the thesis "
        "does not say; their growth does not. Aggressive: one level coarser.\n\n"
        "| aperture | N | finest | aggressive | thesis, finest | ours / thesis |\n"
        "|---|--:|--:|--:|--:|--:|\n");
    for (const QuadRow& row : rows) {
        std::string printed = "-", ratio = "-";
        for (const PrintedCounts& count : printed_counts) {
            if (row.aperture != count.aperture || row.size != count.size) continue;
            printed = fmt::format("{}", count.quads);
            ratio = fmt::format("{:.2f}", static_cast<double>(row.finest) / count.quads);
        }
        fmt::format_to(out, "| {} | {} | {} | {} | {} | {} |\n", row.aperture, row.size, row.finest,
                       row.aggressive, printed, ratio);
    }
}

}  // namespace

std::string thesis_markdown(const DiffractionResults& results) {
    std::string text = "\n## The thesis's tables\n";
    const Out out(text);
    write_quads(out, results.quads);
    return text;
}

}  // namespace obscura
