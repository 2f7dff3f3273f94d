#include "app/models/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "app/models/gltf_file.h"
#include "app/models/obj_file.h"
#include "app/models/ply_file.h"
#include "app/models/stl_file.h"
#include "core/error.h"

namespace obscura {
namespace {

std::string ending_of(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return ending;
}

/// The kind of file that begins so, as an ending; ".obj" where nothing tells.
std::string kind_of_content(const std::filesystem::path& file) {
    char head[6] = {};
    std::ifstream(file, std::ios::binary).read(head, sizeof head - 1);
    const std::string_view begin(head);
    if (begin.starts_with("ply\n") || begin.starts_with("ply\r")) return ".ply";
    if (begin.starts_with("solid")) return ".stl";
    if (begin.starts_with("glTF")) return ".glb";
    return ".obj";
}

}  // namespace

Model load_model(const std::filesystem::path& file, const FileAccess& access, const Limits& limits,
                 const ModelOptions& options) {
    std::string kind = ending_of(file);
    for (const char* other : {".fbx", ".dae", ".3ds", ".blend", ".usd", ".usda", ".usdc", ".usdz", ".abc",
                              ".x3d", ".wrl", ".off", ".step", ".stp", ".iges", ".igs"}) {
        if (kind == other)
            throw InputError(file.string(),
                             fmt::format("{} files are not read; OBJ, glTF, PLY and STL are", other));
    }
    if (kind != ".obj" && kind != ".ply" && kind != ".stl" && kind != ".gltf" && kind != ".glb")
        kind = kind_of_content(file);
    if (kind == ".gltf" || kind == ".glb") return load_gltf(file, access, limits, options);
    if (kind == ".ply") return load_ply(file, limits, options);
    if (kind == ".stl") return load_stl(file, limits, options);
    return load_obj(file, access, limits, options);
}

}  // namespace obscura
