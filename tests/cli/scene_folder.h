#pragma once
// A folder with the small scene, and pictures out of folders.

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "core/image_io.h"
#include "tests/cli/program.h"

namespace obscura::test {

using Names = std::vector<std::string>;

/// A folder with the small scene in it.
struct SceneFolder : Folder {
    explicit SceneFolder(const std::string& more = "") { write("s.toml", small_scene + more); }
};

inline Image<Rgba8> png(const std::filesystem::path& file) {
    return decode_png(file_text(file), file.string());
}

template <class T = float>
Image<T> pfm(const std::filesystem::path& file) {
    return std::get<Image<T>>(decode_pfm(file_text(file), file.string()));
}

}  // namespace obscura::test
