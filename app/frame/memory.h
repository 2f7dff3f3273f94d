#pragma once
// What a scene takes, and whether it may.

#include <cstdint>
#include <string>

#include "app/scene/scene.h"
#include "app/scene/scene_file.h"

namespace obscura {

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
int shadow_map_count(const SceneLight& light);
std::int64_t shadow_map_bytes(const SceneLight& light);

/// Throws LimitError when `estimate` exceeds limits.memory_mib.
void check_memory(const MemoryEstimate& estimate, const Limits& limits, const std::string& scene_name);

}  // namespace obscura
