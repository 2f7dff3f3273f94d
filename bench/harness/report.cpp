#include "bench/harness/report.h"

#include <fmt/format.h>

#include <system_error>

#include "core/error.h"
#include "core/file_output.h"

namespace obscura {

std::string threads_text(int threads) {
    return threads == 1 ? "1 thread" : fmt::format("{} threads", threads);
}

std::string report_head(const char* title, const char* small, const BenchOptions& options) {
    std::string text = fmt::format("# {}\n\n", title);
    if (options.quick)
        text += fmt::format("Quick run: {}, a check of the bench and not a measurement.\n\n", small);
    return text;
}

void check_chosen(bool any, const BenchOptions& options, const char* kind) {
    if (!any) throw UsageError(fmt::format("no bench {} has \"{}\" in its name", kind, options.scene));
}

void make_output_folder(const BenchOptions& options) {
    std::error_code error;
    std::filesystem::create_directories(options.out, error);
    if (error) throw OutputError(fmt::format("{}: {}", options.out.string(), error.message()));
}

void write_files(const BenchOptions& options, const std::vector<ReportFile>& files) {
    for (const ReportFile& file : files) {
        if (!file.text.empty()) write_file_atomically(options.out / file.name, file.text, Existing::replace);
    }
}

}  // namespace obscura
