#pragma once

#include "core/mesh.h"
#include "scenes/random.h"

namespace obscura {

/// Adds one leaf: a thin closed solid of four triangles (base, tip and the two edges of the blade; the midrib
/// is folded up, the keel down), `length_m` long, growing from `at` along the unit vector `along`, its upper
/// face turned as far as possible towards `up`.
void add_leaf(Mesh& mesh, Vec3d at, Vec3d along, Vec3d up, double length_m, std::uint32_t material);

/// A unit vector, uniform over the sphere.
Vec3d random_direction(Random& random);

}  // namespace obscura
