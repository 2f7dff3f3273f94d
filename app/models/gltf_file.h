#pragma once
// glTF 2.0 files: .gltf with what it names, and .glb.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "app/models/file_access.h"
#include "app/models/model.h"
#include "core/limits.h"

namespace obscura {

/// Reads the triangles of the scene that a glTF file shows, placed by its nodes, each of which is an object.
/// Equal points of a node are one, so that surfaces which are split where materials or normals change are
/// closed. Materials: base colour (factor and PNG texture), metallic, roughness, emission (factor and
/// strength). The rest is told in notes: normal maps, transparency, animations, lights ... Buffers and images
/// may be data URIs, in the file, or files beside it within `access`. Throws InputError, which says where
/// ("accessors[3]"), for what is not sound glTF 2.0, required extensions that are not known, sparse
/// accessors; LimitError beyond limits.triangles triangles or three times as many vertices, and for files
/// larger than an eighth of limits.memory_mib.
Model load_gltf(const std::filesystem::path& file, const FileAccess& access, const Limits& limits,
                const ModelOptions& options = {});

/// The same from memory; `read(uri)`: the bytes of a file that it names.
Model gltf_from_bytes(std::string_view bytes, const std::string& file, const Limits& limits,
                      const ModelOptions& options,
                      const std::function<std::string(const std::string&)>& read);

}  // namespace obscura
