#pragma once
// A model as its file has it, whatever kind of file that is.

#include <cstddef>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/scene.h"
#include "core/topology.h"

namespace obscura {

struct Model {
    Mesh mesh;     ///< material ids index `materials`; stands about `origin`
    Vec3d origin;  ///< to be added for the file's own frame; 0 unless its numbers are large, see origin_of()
    std::vector<Material> materials;
    std::vector<std::string> texture_files;  ///< canonical paths; Material::texture is an index into these
    std::vector<std::string> texture_bytes;  ///< of those that lie in the model's file; empty: none does
    TopologyReport topology;
    std::vector<bool> without_uv;      ///< triangles that textures do not show on, see FacesMesh
    std::size_t file_positions = 0;    ///< points that the file lists, used or not
    std::vector<std::string> missing;  ///< what ModelOptions::allow_missing let pass, as messages
    std::vector<std::string> notes;  ///< what the file has and the model has not, each kind once, as messages
};

struct ModelOptions {
    double crease_angle_deg = 40.0;  ///< where the file has neither normals nor smoothing groups
    /// Missing mtllib, material or texture: plain grey and a word in Model::missing.
    bool allow_missing = false;
    bool textures = true;               ///< false: textures may be missing, as with allow_missing
    bool materials = true;              ///< false: none are read, all triangles have material 0
    std::vector<std::string> replaced;  ///< materials whose look is not wanted: nothing of theirs is opened
};

}  // namespace obscura
