#include "app/models/model_file.h"

#include <fmt/format.h>

#include <algorithm>
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
    if (kind == ".gltf" || kind == ".glb") return load_gltf(file, access, limits, options);
    if (kind == ".ply") return load_ply(file, limits, options);
    if (kind == ".stl") return load_stl(file, limits, options);
    if (kind != ".obj") {
        // By how it begins.
        const std::string bytes = read_model_bytes(file, limits);
        if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r"))
            return ply_from_bytes(bytes, file.string(), limits, options);
        if (bytes.starts_with("solid")) return stl_from_bytes(bytes, file.string(), limits, options);
        if (bytes.starts_with("glTF")) return load_gltf(file, access, limits, options);
    }
    return load_obj(file, access, limits, options);
}

}  // namespace obscura
