#pragma once
// What single precision costs a mesh where it stands.

#include <string>

#include "core/mesh.h"

namespace obscura {

/// Far from the origin floats are coarse, and details of a few of their steps are lost or bent: a note when
/// more than one triangle in a thousand collapses or one in ten is about to, else empty. `made`: the mesh
/// before it was placed, or null when none of its triangles was flat there.
std::string rounding_note(const std::string& whose, const Mesh* made, const Mesh& placed);

}  // namespace obscura
