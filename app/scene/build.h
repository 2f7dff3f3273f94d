#pragma once
// From a validated document to what is rendered.

#include "app/models/file_access.h"
#include "app/scene/scene.h"
#include "app/scene/scene_file.h"

namespace obscura {

/// Loads and makes every mesh, places all instances in one world-space mesh, decodes textures, and sets
/// camera and lights to the first frame. Topology and planar faces are filled. Limits are checked before
/// allocating where sizes can be known before. Throws InputError, LimitError.
Scene build_scene(const SceneDocument& document, const FileAccess& access);

/// Sets camera, lens and lights to `frame`; nothing else depends on it. Cheap.
void set_frame(Scene& scene, const SceneDocument& document, double frame);

/// Of a [[mesh]], beside its shape, materials and place.
struct MeshOptions {
    double crease_angle_deg = 40;  ///< of files without normals and smoothing groups
    bool casts_shadow = true, flip_faces = false;
};

// The parts of a document that need no files, each beside the rows of its keys.
Camera camera_of(const SceneTable& camera);
SceneLight light_of(const SceneTable& light);
ShadowSettings shadow_settings_of(const SceneTable& shadow);
/// Without its texture.
Material material_of(const std::string& name, const SceneTable& material);
Sky sky_of(const SceneDocument& document);
std::vector<Output> outputs_of(const SceneDocument& document);
Limits limits_of(const SceneDocument& document);
RenderSettings render_settings_of(const SceneDocument& document);
MeshOptions mesh_options_of(const SceneTable& mesh);
/// What maps a mesh, or an instance of one, to its place.
Affine placement_of(const SceneTable& mesh);
/// The lens at a frame, without the mask of a file; not enabled where the scene has no [optics].
OpticsSettings optics_of(const SceneDocument& document, double frame);

}  // namespace obscura
