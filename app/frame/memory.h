#pragma once
// What a scene takes, and whether it may: the sum of what the parts say of themselves.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "app/frame/frame.h"
#include "app/scene/scene.h"
#include "app/scene/scene_file.h"

namespace obscura {

/// Bytes that rendering one frame holds at once: what `check` and `render` tell and rendering is held to.
/// Steps come one after the other, so of what only one of them holds the largest counts (app/frame/README.md
/// has the model and what was measured). What follows the picture is expected, and held to the limit as soon
/// as it is known: lists of tiles, surfaces behind one another, what lookups read of compressed maps and
/// their nodes, bright pixels and the patterns of their own. `frame`: pictures and everything that works on
/// them.
struct MemoryEstimate {
    std::int64_t meshes = 0, textures = 0, shadow_maps = 0, frame = 0;
    std::int64_t stacks = 0;  ///< of shadow_maps and frame, what stacks take and making them
    std::int64_t total() const { return meshes + textures + shadow_maps + frame; }
};

/// What is known by the time of asking, in place of what is expected.
struct KnownNeeds {
    std::optional<std::span<const SceneLight>> lights;  ///< the scene's, with the resolutions that were found
    std::optional<std::int64_t> bright_px;              ///< pixels that glare
    FrameOptions channels;                              ///< that are wanted beside radiance
};

/// Of a scene that is built.
MemoryEstimate estimate_memory(const Scene& scene, const KnownNeeds& known = {});
/// Of a document before anything is loaded: shapes by their bounds, files and textures as nothing.
MemoryEstimate estimate_memory(const SceneDocument& document);

/// Throws LimitError when `estimate` exceeds limits.memory_mib.
void check_memory(const MemoryEstimate& estimate, const Limits& limits, const std::string& scene_name);

}  // namespace obscura
