#pragma once
// The same views in the two languages the peers speak: pencils of rays (Embree) and clip-space matrices
// (OpenGL). Both keep our convention that row 0 is the top row, so results compare texel by texel.

#include "core/mesh.h"
#include "core/scene.h"
#include "core/types.h"

namespace obscura {

/// Rays through the centres of a grid: the ray of texel (x, y) starts at origin + x origin_dx + y origin_dy
/// and heads along direction + x direction_dx + y direction_dy (not of unit length).
struct RayGrid {
    Vec3d origin, origin_dx, origin_dy;
    Vec3d direction, direction_dx, direction_dy;
};

/// Rays of an orthographic light view. The direction spans the depth range: t of a hit *is* its map depth.
RayGrid rays_of(const LightView& light);

/// Rays of a perspective camera for a width x height picture; the direction has depth 1 along the view axis.
RayGrid rays_of(const Camera& camera, int width, int height);

/// OpenGL clip space of an orthographic light view: window depth equals map depth, and window row j is map
/// row j. That flips the picture against OpenGL's habit, so triangles that face the viewer are *clockwise*.
Mat4 clip_from_world(const LightView& light);

/// The same for a perspective camera; depths between near_m and far_m. Facing triangles are clockwise here
/// too.
Mat4 clip_from_world(const Camera& camera, int width, int height, double near_m, double far_m);

}  // namespace obscura
