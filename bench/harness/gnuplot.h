#pragma once
// gnuplot, which draws the charts.

#include <filesystem>
#include <string>

#include "bench/harness/options.h"

namespace obscura {

/// Whether gnuplot can be started.
bool has_gnuplot();
/// The same; when it cannot, says that there are only tables and no `what`.
bool can_draw(const BenchOptions& options, const char* what = "charts");

/// How a method looks: one of Okabe and Ito's colours, and gnuplot's point types.
struct MethodStyle {
    const char* color;
    int hollow, filled;
};

/// gnuplot's single-quoted string.
std::string gnuplot_text(const std::string& text);

/// Feeds `script` to gnuplot, which writes `file` when it is done. Throws OutputError when it fails.
void run_gnuplot(const std::string& script, const std::filesystem::path& file);

}  // namespace obscura
