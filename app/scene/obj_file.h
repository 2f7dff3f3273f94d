#pragma once
// OBJ and MTL files.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/file_access.h"
#include "app/scene/scene.h"
#include "core/mesh.h"
#include "core/topology.h"

namespace obscura {

struct ObjModel {
    Mesh mesh;     ///< material ids index `materials`; stands about `origin`
    Vec3d origin;  ///< to be added for the file's own frame; 0 unless its numbers are large, see origin_of()
    std::vector<Material> materials;
    std::vector<std::string> texture_files;  ///< canonical paths; Material::texture is an index into these
    TopologyReport topology;
    std::vector<bool> without_uv;      ///< triangles that textures do not show on, see ObjMesh
    std::size_t file_positions = 0;    ///< v lines, used or not
    std::vector<std::string> missing;  ///< what ObjOptions::allow_missing let pass, as messages
    std::vector<std::string> notes;  ///< what the file has and the model has not, each kind once, as messages
};

struct ObjOptions {
    double crease_angle_deg = 40.0;  ///< where the file has neither normals nor smoothing groups
    bool allow_missing =
        false;  ///< missing mtllib, material or texture: plain grey and a word in ObjModel::missing
    bool textures = true;               ///< false: textures may be missing, as with allow_missing
    bool materials = true;              ///< false: none are read, all triangles have material 0
    std::vector<std::string> replaced;  ///< materials whose look is not wanted: nothing of theirs is opened
};

/// Reads an OBJ file and the MTL files it names. `file` is a path from resolve_input(), or one the user gave.
/// MTL files and textures are found beside the file that names them and must lie within `access`.
/// Throws InputError with file and line for anything that is not a sound OBJ or MTL file; LimitError when the
/// text is larger than an eighth of limits.memory_mib or has more than limits.triangles triangles.
///
/// A name, of a material or texture, may be followed by a comment when there is none with the comment in it.
/// Materials: base_color = Kd (taken as linear, clamped to 1); emission = Ke; texture = map_Kd (with nothing
/// but plain options); roughness = Pr if given, else from the Blinn-Phong exponent, alpha = sqrt(2 / (Ns +
/// 2)) (Walter et al. 2007, section 5.3) with roughness = sqrt(alpha), and 1 where Ks is black or Ns is
/// missing; metallic = Pm if given, else 1 where Kd is black and Ks is not (base_color = Ks then), else 0.
/// Faces before any usemtl get a material called "default".
ObjModel load_obj(const std::filesystem::path& file, const FileAccess& access, const Limits& limits,
                  const ObjOptions& options = {});

/// The same from memory: every mtllib means `mtl`, textures are not looked up but kept by name.
ObjModel obj_from_text(std::string_view obj, std::string_view mtl, const Limits& limits,
                       const ObjOptions& options = {});

}  // namespace obscura
