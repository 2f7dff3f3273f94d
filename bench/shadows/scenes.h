#pragma once
// Scenes whose shadows are measured: one directional light, a camera that sees near and far shadows.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace obscura {

/// Size of the picture whose pixels ask for shadows; width is a multiple of 64, height of 4.
struct PictureSize {
    int width = 1920, height = 1080;
};

/// A scene by name. `make` loads or generates its mesh, which must have normals (throws InputError).
struct ShadowRecipe {
    std::string name;
    std::string what;  ///< one line for readers of the report
    Vec3d sun;         ///< the way its light travels, not unit
    Vec3d eye;         ///< from the middle of the scene's ground, in half extents of the scene (the larger
                       ///< of x and z), y up from its lowest point
    Vec3d look_at;     ///< likewise
    std::function<Mesh()> make;
};

/// Cities of boxes and of the generator; with `data` also real buildings, scans and a tree, those whose files
/// are there. `quick`: the small city alone.
std::vector<ShadowRecipe> shadow_recipes(const std::optional<std::filesystem::path>& data, bool quick);

/// A scene with its topology, one material, its camera and lights[0], which has no shadow map of its own
/// (methods make theirs by shadow_light()).
Scene stage_shadows(const ShadowRecipe& recipe, const PictureSize& size);

/// lights[0] with a map of `resolution` texels a side, looked up with kernels of `side` texels.
SceneLight shadow_light(const Scene& scene, int resolution, int side);

}  // namespace obscura
