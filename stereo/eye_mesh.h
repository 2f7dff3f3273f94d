#pragma once
// A moved mesh as one eye's rasterizer wants it.

#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "stereo/moved_mesh.h"

namespace obscura {

/// The moved mesh with `positions` in place of its own, ready for setup_triangles(): every triangle is a
/// planar face of its own, as the change bends the faces of the original. Components, closed or not, stay: a
/// surface without T-junctions stays closed however its points move.
Mesh eye_mesh(const MovedMesh& moved, std::vector<Vec3f> positions, const Exec& exec);

}  // namespace obscura
