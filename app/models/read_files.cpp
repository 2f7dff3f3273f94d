#include "app/models/read_files.h"

#include <sys/stat.h>

#include <optional>

#include "core/file_output.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

std::optional<std::pair<dev_t, ino_t>> node_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return std::pair{status.st_dev, status.st_ino};
}

}  // namespace

void ReadFiles::add(const fs::path& file) {
    if (const auto node = node_of(file)) nodes.insert(*node);
    paths.insert(place_of_output(file));
}

bool ReadFiles::holds(const fs::path& file) const {
    const auto node = node_of(file);
    return (node && nodes.contains(*node)) || paths.contains(place_of_output(file));
}

}  // namespace obscura
