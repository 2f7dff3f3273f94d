#pragma once

#include <vector>

#include "core/mesh.h"
#include "core/vec.h"

namespace obscura {

/// Triangles of a simple polygon (counter-clockwise, concave allowed, corners may lie on one line, as far
/// as rounding lets them),
/// as indices into `outline`. Ear clipping (Meisters 1975, "Polygons have ears"), always the roundest ear
/// first, O(n^3): outlines of the generators have tens of corners.
std::vector<Triangle> triangulate(const std::vector<Vec2d>& outline);

}  // namespace obscura
