// The thesis's tables and figures beside ours, as ratios.

#include <fmt/format.h>

#include <iterator>

#include "bench/diffraction/report.h"

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
        "\n### Quads (Table 3.1)\n\nCounts depend on the shape's size and on how it lies on the grid, which "
        "the thesis does not say: one size and place per aperture was chosen to match, for all N alike. "
        "Aggressive: one level coarser.\n\n"
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

std::string over(double a, double b) {
    return a > 0 && b > 0 ? fmt::format("{:.2f}", a / b) : std::string("-");
}

/// A table's times at 256, 512, 1024, 2048, 4096.
struct PrintedTimes {
    int size;
    double first, second, third, fourth;
};

const PrintedTimes* printed_at(const PrintedTimes (&table)[5], int size) {
    for (const PrintedTimes& row : table) {
        if (row.size == size) return &row;
    }
    return nullptr;
}

/// Table 3.2: none, culling, symmetry, both.
constexpr PrintedTimes printed_culling[5] = {{256, 0.13, 0.21, 0.14, 0.14},
                                             {512, 0.40, 0.32, 0.25, 0.26},
                                             {1024, 2.25, 1.06, 1.20, 0.71},
                                             {2048, 19.46, 5.65, 9.76, 3.57},
                                             {4096, 139.35, 31.63, 74.70, 20.22}};
/// Table 3.3: full, batch.
constexpr PrintedTimes printed_spectra[5] = {{256, 0.040, 0.019, 0, 0},
                                             {512, 0.127, 0.038, 0, 0},
                                             {1024, 0.530, 0.114, 0, 0},
                                             {2048, 1.960, 0.430, 0, 0},
                                             {4096, 8.180, 1.710, 0, 0}};
/// Table 3.4: fractional FT on the CPU, FFT on the GPU, the thesis on the GPU, all of whirl.
constexpr PrintedTimes printed_near[5] = {{256, 15.98, 4.87, 0.16, 0},
                                          {512, 33.01, 20.94, 0.49, 0},
                                          {1024, 128.72, 94.73, 2.93, 0},
                                          {2048, 533.85, 0, 23.42, 0},
                                          {4096, 2133.19, 0, 255.72, 0}};

void write_culling(Out out, const std::vector<CullRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(
        out,
        "\n### Culling and symmetry (Table 3.2)\n\nMethod `edges`, heptagon, whole plane, one thread; "
        "blocks below 1e-6 of the peak are culled. Factors are times without either over times "
        "with it. Without \"symmetry\" the sums still share what rows v and -v have in common, so there "
        "is less left to gain than in the thesis.\n\n"
        "| N | ms, neither | culling x | symmetry x | both x | blocks kept | thesis: culling x | "
        "symmetry x | both x |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const CullRow& row : rows) {
        fmt::format_to(out, "| {} | {:.3g} | {} | {} | {} | {:.1f} %", row.size, row.plain_ms,
                       over(row.plain_ms, row.cull_ms), over(row.plain_ms, row.symmetry_ms),
                       over(row.plain_ms, row.both_ms), 100 * row.active);
        const PrintedTimes* p = printed_at(printed_culling, row.size);
        fmt::format_to(out, " | {} | {} | {} |\n", p ? over(p->first, p->second) : "-",
                       p ? over(p->first, p->third) : "-", p ? over(p->first, p->fourth) : "-");
    }
}

void write_spectra(Out out, const std::vector<SpectralRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(
        out,
        "\n### Adding wavelengths (Table 3.3)\n\nA given pattern, bilinear lookups, one thread: 60 "
        "scales against 4 + 15 times 4.\n\n| N | ms, full | ms, batch | full / batch | thesis: full / "
        "batch |\n|--:|--:|--:|--:|--:|\n");
    for (const SpectralRow& row : rows) {
        const PrintedTimes* p = printed_at(printed_spectra, row.size);
        fmt::format_to(out, "| {} | {:.3g} | {:.3g} | {} | {} |\n", row.size, row.full_ms, row.batch_ms,
                       over(row.full_ms, row.batch_ms), p ? over(p->first, p->second) : "-");
    }
}

void write_near(Out out, const std::vector<DiffractionRow>& rows) {
    std::string table;
    for (const DiffractionRow& row : rows) {
        if (row.part != near_part || row.aperture != "whirl" || row.method != automatic_name ||
            row.threads != 1 || row.time.calls == 0)
            continue;
        const PrintedTimes* p = printed_at(printed_near, row.size);
        fmt::format_to(Out(table), "| {} | {:.3g} | {} | {} | {} | {} |\n", row.size, row.time.least_ms,
                       over(least_ms(rows, row, fftw_near_name, false), row.time.least_ms),
                       over(least_ms(rows, row, fftw_near8_name, false), row.time.least_ms),
                       p ? over(p->first, p->third) : "-", p ? over(p->second, p->third) : "-");
    }
    if (table.empty()) return;
    fmt::format_to(
        out,
        "\n### Near field (Table 3.4)\n\nWhirl, one thread. FFTW with the sampled chirp and 8-fold "
        "padding does what the thesis's GPU-NFD does; one size shows it.\n\n"
        "| M | ms, ours | FFTW, 2x padded / ours | FFTW, 8x padded / ours | thesis: CPU-FrFT / theirs "
        "| GPU-NFD / theirs |\n|--:|--:|--:|--:|--:|--:|\n{}",
        table);
}

void write_quality(Out out, const std::vector<QualityRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(
        out,
        "\n### Coarser masks (Figures 3.8 and 3.9)\n\nPatterns of the finest mask (half the image's side) "
        "and of the aggressive one (a quarter) against the exact pattern of the anti-aliased image, "
        "{} x {} pixels. Far fields are clipped at 1e-4 of their peak; near fields at Fresnel number 10. "
        "The thesis has SSIM 0.997 to 1.000 and 50 to 65 dB in Figure 3.8, 0.99 and 37.5 to 55.9 dB in "
        "Figure 3.9; how it scaled its pictures is not said.\n\n"
        "| field | aperture | level | quads | SSIM | PSNR, dB |\n|---|---|---|--:|--:|--:|\n",
        rows[0].size, rows[0].size);
    for (const QualityRow& row : rows)
        fmt::format_to(out, "| {} | {} | {} | {} | {:.4f} | {:.1f} |\n", row.field, row.aperture, row.level,
                       row.quads, row.ssim, row.psnr_db);
}

}  // namespace

std::string thesis_markdown(const DiffractionResults& results) {
    std::string text =
        "\n## The thesis's tables\n\nL. Scandolo: Compression and rendering with image-based "
        "representations (thesis, 2019), chapter 3. Its times are those of a GPU: compare factors.\n";
    const Out out(text);
    write_quads(out, results.quads);
    write_culling(out, results.culling);
    write_spectra(out, results.spectra);
    write_near(out, results.rows);
    write_quality(out, results.quality);
    return text;
}

}  // namespace obscura
