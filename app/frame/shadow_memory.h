#pragma once
// What the shadows of lights take: kept, and while they are made.

#include <cstdint>
#include <span>

#include "app/frame/shadow_method.h"
#include "app/scene/scene.h"
#include "core/mesh_memory.h"

namespace obscura {

/// What the shadows of all lights take together: summed, but for `making` (the most of any) and `setup` (the
/// most of each method's, summed).
ShadowBytes shadow_bytes(const MeshSize& mesh, std::span<const SceneLight> lights,
                         const RenderSettings& render);

/// What exact shadows and the sky's take while they are made, beside what they keep.
std::int64_t exact_work_bytes(const MeshSize& mesh, std::span<const SceneLight> lights, const Sky& sky);
/// Of the tiles that threads have in work.
std::int64_t exact_tiles_bytes(std::span<const SceneLight> lights, const Sky& sky);
/// What a pass over the tiles holds, of lights with a size and of a sky that surfaces occlude; expected for
/// discs whose parts the picture counts: sixteen at a time.
std::int64_t soft_passes_bytes(const MeshSize& mesh, std::span<const SceneLight> lights, const Sky& sky,
                               const RenderSettings& render);

/// What hours of sun hold of `steps` suns: a pass over the tiles, with what is set up meanwhile; the tiles
/// that threads have in work; and sums of the picture's pixels.
std::int64_t sun_hours_pass_bytes(const MeshSize& mesh, int steps);
std::int64_t sun_hours_tiles_bytes(const MeshSize& mesh, int steps);
std::int64_t sun_hours_sums_bytes(const RenderSettings& render);

}  // namespace obscura
