#pragma once
// Surfaces that shine: all triangles of a material, as one light.

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "core/vec.h"

namespace obscura {

/// A triangle that gives off light from the side its normal points to.
struct EmitterPiece {
    Vec3d corner[3];
    Vec3d normal;        ///< unit, as its corners turn
    double area_m2 = 0;  ///< more than 0
};

struct EmitterSurface {
    std::vector<EmitterPiece> pieces;
    double area_m2 = 0;
    Vec3d middle{0, 0, 0};  ///< mean of the surface
    double radius_m = 0;    ///< of the ball about `middle` that holds all of it
};

/// What of the mesh has the material, in world space.
EmitterSurface emitter_surface(const Mesh& mesh, std::uint32_t material);

/// A point of a surface, and the share of it that it stands for.
struct EmitterPoint {
    Vec3d position, normal;
    double share = 0;
};

/// `count` points that stand for about as much of the surface each. It is cut in halves of as much area,
/// across the longest side of what it spans in space and, as wide as all of it, in directions it faces; and
/// these again. A point stands near the middle of each of the last parts. Parts that were cut last follow one
/// another, so that every 2nd, 4th ... point is evenly spread as well. Not for surfaces without pieces.
std::vector<EmitterPoint> emitter_points(const EmitterSurface& surface, int count);

}  // namespace obscura
