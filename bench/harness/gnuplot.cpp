#include "bench/harness/gnuplot.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "core/error.h"

namespace obscura {
namespace {

bool in_path(const char* program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (access((folder + '/' + program).c_str(), X_OK) == 0) return true;
    }
    return false;
}

}  // namespace

bool has_gnuplot() {
    return in_path("gnuplot");
}

bool can_draw(const BenchOptions& options, const char* what) {
    const bool can = has_gnuplot();
    if (!can)
        options.say(fmt::format("gnuplot is not installed (package gnuplot-nox): tables only, no {}", what));
    return can;
}

std::string gnuplot_text(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'') out += '\'';
        out += c;
    }
    return out + '\'';
}

void run_gnuplot(const std::string& script, const std::filesystem::path& file) {
    const std::filesystem::path part = file.string() + ".part";
    FILE* gnuplot = popen("gnuplot", "w");
    if (gnuplot == nullptr) throw OutputError("gnuplot cannot be started");
    const std::string whole = fmt::format("set output {}\n{}", gnuplot_text(part.string()), script);
    const bool written = std::fwrite(whole.data(), 1, whole.size(), gnuplot) == whole.size();
    const int status = pclose(gnuplot);
    std::error_code error;
    if (written && status == 0) std::filesystem::rename(part, file, error);
    if (!written || status != 0 || error) {
        throw OutputError(fmt::format("{}: gnuplot could not draw it", file.string()));
    }
}

}  // namespace obscura
