#pragma once
// What the shadows of lights take: kept, and while they are made.

#include <cstdint>
#include <span>

#include "app/scene/scene.h"
#include "core/mesh_memory.h"

namespace obscura {

/// What exact shadows of the lights keep beside the mesh: casters in order, expected for point lights, whose
/// six views share them out; and what ordering them takes meanwhile.
std::int64_t exact_casters_bytes(const MeshSize& mesh, std::span<const SceneLight> lights);
std::int64_t exact_work_bytes(const MeshSize& mesh, std::span<const SceneLight> lights, const Sky& sky);
/// What stacks of lights with a size take, expected; and making the largest of them, beside them.
std::int64_t stacks_bytes(const MeshSize& mesh, std::span<const SceneLight> lights);
std::int64_t making_stacks_bytes(const MeshSize& mesh, std::span<const SceneLight> lights);
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

/// Maps of a light: none without shadows, six for a point light; and the bytes that lookups read of them when
/// all of them is built, exact for dense maps, expected for compressed ones.
int shadow_map_count(const SceneLight& light);
std::int64_t shadow_map_bytes(const SceneLight& light);

/// The same of what a picture of this size has built of it (scope "frame").
std::int64_t built_map_bytes(const SceneLight& light, const RenderSettings& render);

/// Squares (8 x 8 texels, or coarser ones) that a picture's lookups read of one light, expected: 1.2, 3 and
/// 8 per pixel at 1, 4 and 16 samples, which share more of them the closer they lie. No more than the map
/// has, nor than a collection may hold.
std::int64_t expected_squares(const ShadowSettings& shadow, std::int64_t maps, const RenderSettings& render);

/// Bytes held beside the maps while the shadows of `lights` are made: lists of what the picture reads of all
/// of them, and one light's construction at a time.
std::int64_t shadow_work_bytes(const MeshSize& mesh, std::span<const SceneLight> lights,
                               const RenderSettings& render);
/// What is kept with the frame for the next: the setup of dense maps and exact shadows.
std::int64_t kept_setup_bytes(const MeshSize& mesh, std::span<const SceneLight> lights);

}  // namespace obscura
