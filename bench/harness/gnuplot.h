#pragma once
// gnuplot, which draws the charts.

#include <filesystem>
#include <string>

namespace obscura {

/// Whether gnuplot can be started.
bool has_gnuplot();

/// gnuplot's single-quoted string.
std::string gnuplot_text(const std::string& text);

/// Feeds `script` to gnuplot, which writes `file` when it is done. Throws OutputError when it fails.
void run_gnuplot(const std::string& script, const std::filesystem::path& file);

}  // namespace obscura
