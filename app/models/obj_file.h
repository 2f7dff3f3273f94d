#pragma once
// OBJ and MTL files.

#include <filesystem>
#include <string>
#include <string_view>

#include "app/models/file_access.h"
#include "app/models/model.h"
#include "core/limits.h"

namespace obscura {

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
Model load_obj(const std::filesystem::path& file, const FileAccess& access, const Limits& limits,
               const ModelOptions& options = {});

/// The same from memory: every mtllib means `mtl`, textures are not looked up but kept by name.
Model obj_from_text(std::string_view obj, std::string_view mtl, const Limits& limits,
                    const ModelOptions& options = {});

}  // namespace obscura
