#include "bench/diffraction/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "bench/harness/machine.h"
#include "bench/harness/report.h"
#ifdef OBSCURA_HAS_FFTW
#include "bench/diffraction/peer_fftw.h"
#endif

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

std::string time_cell(double ms) {
    return ms > 0 ? fmt::format("{:.3g}", ms) : std::string("-");
}

std::string ratio_cell(double peer_ms, double our_ms) {
    return peer_ms > 0 && our_ms > 0 ? fmt::format("{:.2f}", peer_ms / our_ms) : std::string("-");
}

std::string error_cell(double error) {
    return error >= 0 ? fmt::format("{:.1e}", error) : std::string("-");
}

std::string decibel_cell(double value) {
    return value >= 0 ? fmt::format("{:.0f}", value) : std::string("-");
}

/// Further lines for the table of the machine.
std::vector<MachineLine> libraries() {
#ifdef OBSCURA_HAS_FFTW
    return {{"FFTW", fftw_version() + ", FFTW_MEASURE"}};
#else
    return {{"FFTW", "absent"}};
#endif
}

/// The automatic choice beside the part's peers.
void write_ratios(Out out, const std::vector<DiffractionRow>& rows, const std::string& part,
                  const std::vector<std::string>& peers, bool one_call) {
    const std::vector<int> threads = thread_counts(rows);
    fmt::format_to(out, "| aperture | size | choice");
    for (const int count : threads) {
        fmt::format_to(out, " | ms, {}", threads_text(count));
        for (const std::string& peer : peers)
            fmt::format_to(out, " | {} / ours", peer);
    }
    fmt::format_to(out, " |\n|---|--:|---");
    for (std::size_t i = 0; i < threads.size() * (1 + peers.size()); ++i)
        fmt::format_to(out, "|--:");
    fmt::format_to(out, "|\n");
    for (const DiffractionRow& row : rows) {
        if (row.part != part || row.method != automatic_name || row.one_call != one_call ||
            row.threads != threads[0])
            continue;
        fmt::format_to(out, "| {} | {} | {}", row.aperture, row.size, row.note);
        for (const int count : threads) {
            DiffractionRow like = row;
            like.threads = count;
            const double ours = least_ms(rows, like, automatic_name, one_call);
            fmt::format_to(out, " | {}", time_cell(ours));
            for (const std::string& peer : peers)
                fmt::format_to(out, " | {}", ratio_cell(least_ms(rows, like, peer, false), ours));
        }
        fmt::format_to(out, " |\n");
    }
}

/// Every method of a part.
void write_methods(Out out, const std::vector<DiffractionRow>& rows, const std::string& part) {
    const std::vector<int> threads = thread_counts(rows);
    fmt::format_to(out, "\n| aperture | size | method");
    for (const int count : threads)
        fmt::format_to(out, " | ms, {}", threads_text(count));
    fmt::format_to(out, " | amplitude error | log PSNR, dB | made before, ms |\n|---|--:|---");
    for (std::size_t i = 0; i < threads.size(); ++i)
        fmt::format_to(out, "|--:");
    fmt::format_to(out, "|--:|--:|--:|\n");
    for (const DiffractionRow& row : rows) {
        if (row.part != part || row.threads != threads[0]) continue;
        const bool has_both = part == far_part && !row.peer && row.one_call;
        const bool kept_too = has_both && least_ms(rows, row, row.method, false) > 0;
        fmt::format_to(out, "| {} | {} | {}{}", row.aperture, row.size, row.method,
                       kept_too ? ", one call" : "");
        for (const int count : threads) {
            DiffractionRow like = row;
            like.threads = count;
            const double ms = least_ms(rows, like, row.method, row.one_call);
            fmt::format_to(out, " | {}", ms > 0 || row.problem.empty() ? time_cell(ms) : row.problem);
        }
        fmt::format_to(out, " | {} | {} | {} |\n", error_cell(row.error), decibel_cell(row.log_psnr_db),
                       row.prepare_ms > 0 ? time_cell(row.prepare_ms) : "");
    }
}

void write_far(Out out, const std::vector<DiffractionRow>& rows) {
    if (rows_where(rows, [](const DiffractionRow& row) { return row.part == far_part; }).empty()) return;
    fmt::format_to(
        out,
        "\n## Far field\n\n![chart](diffraction_time.svg)\n\n![chart](diffraction_error.svg)\n\n"
        "Least milliseconds for the power over the half plane of N x (N / 2 + 1) frequencies. Ours: "
        "the automatic choice, with the tables of the size kept.\n\n");
    write_ratios(out, rows, far_part, {fftw_image_name, fftw_mask_name}, false);
    fmt::format_to(
        out,
        "\nEvery strategy. Errors are against the closed form of the mask in double, as a share of "
        "the open area; `{}` and `polygon` compute another function, the image and the exact "
        "outline.\n",
        fftw_image_name);
    write_methods(out, rows, far_part);
}

void write_part(Out out, const std::vector<DiffractionRow>& rows, const std::string& part, const char* head,
                const std::vector<std::string>& peers) {
    if (rows_where(rows, [&](const DiffractionRow& row) { return row.part == part; }).empty()) return;
    fmt::format_to(out, "{}", head);
    write_ratios(out, rows, part, peers, true);
    write_methods(out, rows, part);
}

void write_controls(Out out, const std::vector<ControlRow>& rows) {
    if (rows.empty()) return;
    fmt::format_to(out,
                   "\n### Why chirps must be integrated over texels\n\nLargest error of the same FFT "
                   "convolution with the chirp sampled at the middle of each texel, and integrated over it "
                   "({} texels a side, heptagon): what the thesis's Figure 3.12 shows.\n\n"
                   "| Fresnel number | sampled | integrated | ours |\n|--:|--:|--:|--:|\n",
                   rows[0].size);
    for (const ControlRow& row : rows)
        fmt::format_to(out, "| {} | {} | {} | {} |\n", row.fresnel_number, error_cell(row.sampled_error),
                       error_cell(row.integrated_error), error_cell(row.our_error));
}

}  // namespace

std::vector<DiffractionRow> rows_where(const std::vector<DiffractionRow>& rows,
                                       const std::function<bool(const DiffractionRow&)>& take) {
    std::vector<DiffractionRow> taken;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(taken), take);
    return taken;
}

double least_ms(const std::vector<DiffractionRow>& rows, const DiffractionRow& like,
                const std::string& method, bool one_call) {
    for (const DiffractionRow& row : rows) {
        if (row.part == like.part && row.aperture == like.aperture && row.size == like.size &&
            row.threads == like.threads && row.method == method && row.one_call == one_call)
            return row.time.calls > 0 ? row.time.least_ms : 0;
    }
    return 0;
}

std::string diffraction_csv(const std::vector<DiffractionRow>& rows) {
    std::string text =
        "part,aperture,size,method,threads,one_call,least_ms,median_ms,calls,prepare_ms,amplitude_error,"
        "log_psnr_db,choice,problem\n";
    for (const DiffractionRow& row : rows) {
        std::string problem = row.problem;
        std::replace(problem.begin(), problem.end(), ',', ';');
        fmt::format_to(Out(text), "{},{},{},\"{}\",{},{},{:.5f},{:.5f},{},{:.3f},{:.3e},{:.2f},{},{}\n",
                       row.part, row.aperture, row.size, row.method, row.threads, row.one_call ? 1 : 0,
                       row.time.least_ms, row.time.median_ms, row.time.calls, row.prepare_ms, row.error,
                       row.log_psnr_db, row.note, problem);
    }
    return text;
}

std::string diffraction_markdown(const DiffractionResults& results, const BenchOptions& options) {
    std::string text = report_head("Diffraction bench", "small apertures", options);
    const Out out(text);
    fmt::format_to(out,
                   "Least of up to {} interleaved turns after a warm-up. What is measured, and how: "
                   "bench/README.md.\n\n",
                   options.runs);
    text += goals_markdown(results);
    text += '\n' + machine_markdown(libraries());
    write_far(out, results.rows);
    write_part(out, results.rows, window_part,
               "\n## Windows of finer frequencies\n\n![chart](diffraction_window.svg)\n\nA square window, "
               "steps a quarter as wide as the half plane's, off the centre. FFTW pads the mask to 4 times "
               "its side. Sizes are those of the image, N; masks have N / 2 texels a side.\n\n",
               {fftw_padded_name});
    write_part(out, results.rows, near_part,
               "\n## Near "
               "field\n\n![chart](diffraction_near.svg)\n\n![chart](diffraction_near_error.svg)\n\nFresnel "
               "number 10, as many pixels as the "
               "mask has texels, over the mask's square. FFTW: linear convolution with the integrated chirp, "
               "whose spectrum is made before. Errors in shares of the unobstructed wave.\n\n",
               {fftw_near_name});
    write_controls(out, results.controls);
    text += thesis_markdown(results);
    return text;
}

void write_diffraction_report(const DiffractionResults& results, const BenchOptions& options) {
    write_files(options, {{"diffraction.csv", diffraction_csv(results.rows)},
                          {"diffraction.md", diffraction_markdown(results, options)}});
}

}  // namespace obscura
