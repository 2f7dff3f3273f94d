#pragma once
// Files that hold models, of whatever kind.

#include <filesystem>

#include "app/models/file_access.h"
#include "app/models/model.h"
#include "core/limits.h"

namespace obscura {

/// Reads a model by what its name ends in, else by how it begins, else as OBJ: load_obj(), load_gltf(),
/// load_ply(), load_stl(). What the file names in turn must lie within `access`. Throws as they do, and
/// InputError for kinds of files that are known but not read.
Model load_model(const std::filesystem::path& file, const FileAccess& access, const Limits& limits,
                 const ModelOptions& options = {});

}  // namespace obscura
