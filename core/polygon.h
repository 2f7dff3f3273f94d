#pragma once
// Polygons to triangles.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace obscura {

/// Cuts a polygon of n >= 3 corners into n - 2 triangles (corner numbers, same sense of rotation) by clipping
/// ears (Meisters, Polygons have ears, 1975) in the plane across which the polygon's area is largest.
/// Simple polygons, concave ones too: the triangles tile it, every corner is used, and none is degenerate
/// unless the polygon itself is. Corners in the middle of a straight side and outlines that walk a bridge to
/// a hole and back are fine. Self-intersecting or flat polygons: some n - 2 triangles, the same ones every
/// time. O(n r) with r reflex corners.
std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(std::span<const Vec3f> corners);

}  // namespace obscura
