#pragma once
// STL files: text and binary.

#include <filesystem>
#include <string>
#include <string_view>

#include "app/models/model.h"
#include "core/limits.h"

namespace obscura {

/// Reads the triangles of an STL file (3D Systems, 1989). Corners that are equal numbers are one vertex, so
/// that closed surfaces are closed; normals come from the triangles, not from the file. The solids of a text
/// are objects by name. Everything has the material "default". A file is binary when its length is what its
/// count of triangles asks for, else a text when it begins with "solid". Throws InputError with the line, or
/// the triangle, for anything else and for numbers that are not finite; LimitError beyond limits.triangles.
Model stl_from_bytes(std::string_view bytes, const std::string& file, const Limits& limits,
                     const ModelOptions& options = {});

/// The same from disk. LimitError, too, for files larger than an eighth of limits.memory_mib.
Model load_stl(const std::filesystem::path& file, const Limits& limits, const ModelOptions& options = {});

}  // namespace obscura
