#pragma once
// [[terrain]]: elevation models as meshes.

#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/elevation/elevation.h"
#include "app/models/file_access.h"
#include "app/scene/scene.h"
#include "app/scene/schema.h"
#include "raster/heights/height_mesh.h"

namespace obscura {

/// Of a [[terrain]], beside its file and material.
struct TerrainOptions {
    ElevationOptions elevation;
    HeightMeshParams mesh;
    bool casts_shadow = true;
};
/// A model may take limits.memory_mib while it is read.
TerrainOptions terrain_options_of(const SceneTable& terrain, const Limits& limits);

/// The model in `file` and, where its kind has one, the description beside it. `named` is how the scene names
/// it. Throws InputError, also for models of a single row or column, LimitError.
ElevationModel load_elevation(const std::filesystem::path& file, const std::string& named,
                              const FileAccess& access, const ElevationOptions& options);

/// The material that shows the last of the textures, under its name.
Material terrain_material(const std::vector<Texture>& textures);

/// What a terrain without a material looks like: meadows, forest, rock and snow by height between the least
/// and the greatest and by slope, level ground at 0 m as water. At most limits.texture_px a side and
/// texture_mib.
Texture terrain_picture(const std::string& name, const ElevationModel& model, const Limits& limits);

}  // namespace obscura
