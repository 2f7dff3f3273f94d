#include "app/cli/targets.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <set>
#include <system_error>

#include "app/cli/messages.h"
#include "core/error.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// Devices such as /dev/null take any number of results.
bool takes_many(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    return fs::exists(status) && !fs::is_regular_file(status);
}

void check_apart(const std::vector<fs::path>& files) {
    std::set<fs::path> places;
    for (const fs::path& file : files) {
        if (!takes_many(file) && !places.insert(place_of_output(file)).second)
            throw UsageError(fmt::format("'{}' would be written twice", file.string()));
    }
}

void check_beside_statistics(const std::vector<fs::path>& results) {
    struct stat out {};
    if (::fstat(STDOUT_FILENO, &out) != 0) return;
    for (const fs::path& file : results) {
        struct stat status {};
        if (::stat(file.c_str(), &status) != 0 || status.st_dev != out.st_dev || status.st_ino != out.st_ino)
            continue;
        throw UsageError(fmt::format("--stats-json -: '{}' is standard output, too", file.string()));
    }
}

std::vector<fs::path> with_statistics(std::vector<fs::path> files, const fs::path& stats_json) {
    if (!stats_json.empty() && !is_standard_output(stats_json)) files.push_back(stats_json);
    return files;
}

}  // namespace

void check_not_read(const std::vector<fs::path>& results, const fs::path& stats_json, const ReadFiles& read) {
    for (const fs::path& file : with_statistics(results, stats_json)) {
        if (read.holds(file))
            throw OutputError(fmt::format("{}: is read by this run and is not replaced", file.string()));
    }
}

void check_targets(const std::vector<fs::path>& results, const fs::path& stats_json, Existing existing,
                   const ReadFiles& read) {
    const std::vector<fs::path> files = with_statistics(results, stats_json);
    check_apart(files);
    if (is_standard_output(stats_json)) check_beside_statistics(results);
    check_not_read(results, stats_json, read);
    for (const fs::path& file : files)
        check_writable(file, existing);
}

bool is_standard_output(const fs::path& stats_json) {
    return stats_json == "-";
}

void write_stats(const fs::path& stats_json, const std::string& json, Existing existing) {
    if (stats_json.empty()) return;
    if (is_standard_output(stats_json)) return print(json);
    write_file_atomically(stats_json, json, existing);
}

}  // namespace obscura
