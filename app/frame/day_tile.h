#pragma once
// A day's shadows of ground over a block of samples.

#include <cstdint>

#include "app/scene/scene.h"
#include "core/vec.h"
#include "hierarchy/terrain/day_shadow.h"
#include "raster/gbuffer.h"

namespace obscura {

/// A day's sun as the tiles of one picture ask it. Borrows the shadow's.
struct DayLight {
    const DaySun* sun = nullptr;
    Vec3d eye;  ///< from the north-western sample at height 0: x east, y up, z south
    Vec3f to_light;
    /// Which triangles of the picture's mesh are the terrain's. Where that is the scene's, they are known by
    /// their numbers; where it has been moved and cut for an eye, by their object and the way they face.
    std::uint32_t first_triangle = 0, ground_triangles = 0, triangles = 0;
    const std::uint32_t* object = nullptr;  ///< of a moved mesh, by triangle; else null
    std::uint32_t own_object = 0;
};

/// Of the scene's mesh; set `object` for another.
DayLight day_light(const DaySun& sun, const SceneTerrain& terrain, const Light& light, Vec3d eye);

/// Whether the ground hides the sun from what a picture sees: from a point on the ground's own triangles by
/// its far bits and a near ray; from one elsewhere, relative to the eye, by a ray over all of the ground. Its
/// walls and its floor are in no shadow of it but their own.
bool day_dark(const DayLight& light, std::uint32_t triangle, Vec3f point, Vec3f normal);

/// Puts 0 for those of a block's covered samples that the ground hides the sun from, and those that look away
/// from it.
void darken_by_ground(const DayLight& light, const SurfaceBlock& surface, float* visibility);

}  // namespace obscura
