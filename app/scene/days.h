#pragma once
// Lights whose shadows of ground are those of a day's file (method = "day").

#include "app/models/file_access.h"
#include "app/scene/scene.h"
#include "app/scene/scene_file.h"
#include "raster/heights/height_field.h"

namespace obscura {

/// Keeps a terrain's field where some light has a day, before `mesh` is appended to the scene's.
void keep_for_days(const SceneDocument& document, const SceneTable& terrain, Vec3d middle_m,
                   HeightField field, const Mesh& mesh, Scene& scene);

/// Opens the files of all lights that have one, finds out which terrain each is of, and fills scene.days.
/// Throws InputError at the key: when a file cannot be read, is altered, or is of no terrain of the scene.
void add_days(const SceneDocument& document, const FileAccess& access, Scene& scene);

}  // namespace obscura
