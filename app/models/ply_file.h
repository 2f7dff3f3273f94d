#pragma once
// PLY files: text and binary, either byte order.

#include <filesystem>
#include <string>
#include <string_view>

#include "app/models/model.h"
#include "core/limits.h"

namespace obscura {

/// Reads the vertices (x y z; nx ny nz; u v, s t or texture_u texture_v) and faces (vertex_indices or
/// vertex_index) of a PLY file; other properties and elements are noted and left out. Everything has the
/// material "default". `file` names the bytes in messages, the model its only object. Throws InputError with
/// the line, or the element, for anything that is not a sound PLY file, for triangle strips, and for numbers
/// that are no finite floats; LimitError beyond limits.triangles triangles or three times as many vertices.
Model ply_from_bytes(std::string_view bytes, const std::string& file, const Limits& limits,
                     const ModelOptions& options = {});

/// The same from disk. LimitError, too, for files larger than an eighth of limits.memory_mib.
Model load_ply(const std::filesystem::path& file, const Limits& limits, const ModelOptions& options = {});

}  // namespace obscura
