#pragma once
// Planar faces: connected triangles on one plane, which must share one set of depth coefficients.

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh.h"

namespace obscura {

/// Fills mesh.face and mesh.faces from positions, triangles and component; `welded` are the triangles with
/// equal positions merged. Faces are numbered by their first triangle.
///
/// A face grows from its largest triangle (ties: by position, so that the order of triangles decides only
/// between identical ones), whose plane it takes, over edges walked in opposite directions within one
/// component. A triangle joins when
///  - each of its corners lies within 4 * 2^-23 * (largest coordinate of it and of the seed) of the plane:
///    each coordinate was rounded by at most half a unit in the last place, which moves a point by at most
///    sqrt(3)/2 units, and the fourth corner of a parallelogram sees the errors of all four corners, 3.5;
///  - its normal is within 1 degree of the plane's, so that a step as small as the tolerance is not laid flat
///    (seen edge-on, depth would explode). Triangles without area join by distance alone.
/// Edges shared by more than 16 triangles are not crossed, which bounds the work.
void find_planar_faces(Mesh& mesh, std::span<const Triangle> welded);

/// Fills mesh.face and mesh.faces with a face for every triangle, its plane as above, without looking for
/// neighbours.
void make_faces_of_triangles(Mesh& mesh);

}  // namespace obscura
