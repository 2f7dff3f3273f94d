#pragma once
// Every file that a scene names to be read, whether this run reads it or not.

#include <filesystem>
#include <vector>

#include "app/scene/scene_file.h"

namespace obscura {

/// Where the values of all file keys lead, relative to the scene's folder as written, in the schema's order;
/// without [[output]]s and folders. A name with \ counts twice, once with / (file_access.h).
std::vector<std::filesystem::path> named_files(const SceneDocument& document);

}  // namespace obscura
