#pragma once
// From a validated document to what is rendered.

#include <cstdint>
#include <string>

#include "app/file_access.h"
#include "app/scene_file.h"
#include "core/scene.h"

namespace obscura {

/// Loads and makes every mesh, places all instances in one world-space mesh, decodes textures, and sets
/// camera and lights to the first frame. Topology and planar faces are filled. Limits are checked before
/// allocating where sizes can be known before. Throws InputError, LimitError.
Scene build_scene(const SceneDocument& document, const FileAccess& access);

/// Sets camera, lens and lights to `frame`; nothing else depends on it. Cheap.
void set_frame(Scene& scene, const SceneDocument& document, double frame);

/// The parts of a document that need no files.
Camera camera_of(const SceneTable& camera);
Light light_of(const SceneTable& light);
Limits limits_of(const SceneDocument& document);
RenderSettings render_settings_of(const SceneDocument& document);
/// The lens at a frame, without the mask of a file; not enabled where the scene has no [optics].
OpticsSettings optics_of(const SceneDocument& document, double frame);

/// Bytes that rendering one frame holds at once: what `check` tells and rendering is held to. A bound but for
/// three things, which follow the picture: lists of tiles with more than eight entries per triangle, layers
/// where more than twelve surfaces lie behind one another, and compressed shadow maps, whose size is expected
/// from their resolution (nothing for "auto" before it is found) and held to the limit as soon as it is
/// known. `frame`: pictures and everything that works on them.
struct MemoryEstimate {
    std::int64_t meshes = 0, textures = 0, shadow_maps = 0, frame = 0;
    std::int64_t total() const { return meshes + textures + shadow_maps + frame; }
};

/// Of a scene that is built.
MemoryEstimate estimate_memory(const Scene& scene);
/// Of a document before anything is loaded: shapes by their bounds, files and textures as nothing.
MemoryEstimate estimate_memory(const SceneDocument& document);

/// Maps of a light: none without shadows, six for a point light; and the bytes that lookups read of them,
/// exact for dense maps, expected for compressed ones.
int shadow_map_count(const Light& light);
std::int64_t shadow_map_bytes(const Light& light);

/// Throws LimitError when `estimate` exceeds limits.memory_mib.
void check_memory(const MemoryEstimate& estimate, const Limits& limits, const std::string& scene_name);

}  // namespace obscura
