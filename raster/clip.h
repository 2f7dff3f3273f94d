#pragma once
// Triangles that reach before the near plane or far off the map, cut to what fixed point can hold.

#include <cstdint>
#include <vector>

#include "core/types.h"

namespace obscura {

/// How far off the map snapped coordinates may lie, in texels: the size of the largest map.
constexpr double guard_band_texels = 1048576.0;

/// A corner in homogeneous map space.
using ClipVertex = Vec4d;

/// Cuts the polygon by the near plane and the four sides of the guard band (Sutherland, Hodgman 1974).
/// A crossing of an edge is computed from its two ends in one fixed order, so the two triangles at an edge
/// get the same point whichever way they walk it. Empty when nothing is left.
std::vector<ClipVertex> clip_polygon(std::vector<ClipVertex> corners, const View& view);

}  // namespace obscura
