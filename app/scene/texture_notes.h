#pragma once
// What textures cannot show on.

#include <functional>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/scene.h"

namespace obscura {

/// A note for every material that has a texture and triangles, of which some have no texture coordinates: as
/// `without_uv` says triangle by triangle, or all where the mesh has none. Mesh::material indexes
/// `materials`, whose textures `name_of` calls by their index; notes begin with `who`.
std::vector<std::string> texture_notes(const std::string& who, const Mesh& mesh,
                                       const std::vector<bool>& without_uv,
                                       const std::vector<Material>& materials,
                                       const std::function<std::string(std::int32_t)>& name_of);

}  // namespace obscura
