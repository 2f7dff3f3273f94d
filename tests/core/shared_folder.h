#pragma once
// What lies beside the sources and is not part of them: real data and cases that tests read in place.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace obscura {

/// Folder or file `name` ("data/stereo", "cases") beside the sources; the environment's OBSCURA_DATA stands
/// for "data".
inline std::filesystem::path shared_folder(const std::string& name) {
    const char* elsewhere = std::getenv("OBSCURA_DATA");
    if (elsewhere != nullptr && (name == "data" || name.starts_with("data/")))
        return std::filesystem::path(elsewhere) / (name == "data" ? "" : name.substr(5));
    return std::filesystem::path(OBSCURA_SOURCE_DIR "/../shared") / name;
}

/// Ends a test aloud where `path` is not there.
#define SKIP_WITHOUT(path) \
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "SKIPPED: no " << (path)

}  // namespace obscura
