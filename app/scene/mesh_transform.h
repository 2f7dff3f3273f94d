#pragma once
// Placing meshes in the world.

#include "core/mesh.h"
#include "core/vec.h"

namespace obscura {

/// The map that scales, then turns about x, then y, then z (degrees, right-hand rule, exact at multiples of
/// 90), then moves.
Affine placement(Vec3d scale, Vec3d rotate_deg, Vec3d translate_m);

/// Maps positions and normals (by cofactors, so that they stay at right angles to the surface). A mirroring
/// map turns the triangles round, so that they stay counter-clockwise from outside. Component ids stay;
/// planar faces are found anew, since rounding moved the corners. `mesh` has been analysed; det(map) != 0.
void transform_mesh(Mesh& mesh, const Affine& map);

/// Turns every triangle and normal inside out.
void flip_faces(Mesh& mesh);

}  // namespace obscura
