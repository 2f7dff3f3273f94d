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
/// it. A file may take an eighth of limits.memory_mib. Throws InputError, also for models of a single row or
/// column, LimitError.
ElevationModel load_elevation(const std::filesystem::path& file, const std::string& named,
                              const FileAccess& access, const Limits& limits,
                              const ElevationOptions& options);

/// What a terrain without a material looks like: meadows, rock and snow by height between the least and the
/// greatest and by slope, level ground at 0 m and below as water. Adds a texture, of at most
/// scene.limits.texture_px a side, half of texture_mib and `max_bytes`, and the material "id/ground" that
/// shows it, whose number is returned.
std::uint32_t add_terrain_look(Scene& scene, const std::string& id, const ElevationModel& model,
                               std::int64_t max_bytes);

}  // namespace obscura
