#pragma once
// The JSON of a glTF file as checked structures: every index leads to something, every view lies in its
// buffer, every accessor in its view.
//
// Khronos, "glTF 2.0 Specification", version 2.0.1.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"

namespace obscura {

/// -1: not given.
using GltfIndex = std::int32_t;

struct GltfBuffer {
    std::string uri;  ///< empty: the file's own binary chunk
    std::int64_t bytes = 0;
};

struct GltfView {
    GltfIndex buffer = -1;
    std::int64_t offset = 0, bytes = 0, stride = 0;  ///< stride 0: packed
};

enum class GltfComponent { int8, uint8, int16, uint16, uint32, float32 };

/// `count` elements of `width` components each.
struct GltfAccessor {
    GltfIndex view = -1;  ///< -1: all are 0
    std::int64_t offset = 0, count = 0;
    GltfComponent component = GltfComponent::float32;
    int width = 1;
    bool normalized = false;
};

struct GltfImage {
    std::string uri;  ///< of a file or of the data itself; empty: in a view
    GltfIndex view = -1;
};

struct GltfMaterial {
    std::string name;
    std::array<double, 4> base_color = {1, 1, 1, 1};
    std::array<double, 3> emission = {0, 0, 0};
    double metallic = 1, roughness = 1;
    GltfIndex image = -1;  ///< of the base colour
    int texture_set = 0;   ///< TEXCOORD_n that it asks
};

enum class GltfMode { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

struct GltfPrimitive {
    GltfMode mode = GltfMode::triangles;
    GltfIndex material = -1, indices = -1;       ///< accessor
    GltfIndex positions = -1, normals = -1;      ///< accessors
    std::vector<GltfIndex> texture_coordinates;  ///< TEXCOORD_0 and on
};

struct GltfMesh {
    std::string name;
    std::vector<GltfPrimitive> primitives;
};

/// p' = m p, column vectors.
struct GltfMatrix {
    double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

struct GltfNode {
    std::string name;
    GltfIndex mesh = -1;
    std::vector<GltfIndex> children;
    GltfMatrix local;
};

struct GltfDocument {
    std::vector<GltfBuffer> buffers;
    std::vector<GltfView> views;
    std::vector<GltfAccessor> accessors;
    std::vector<GltfImage> images;
    std::vector<GltfMaterial> materials;
    std::vector<GltfMesh> meshes;
    std::vector<GltfNode> nodes;
    std::vector<GltfIndex>
        roots;  ///< nodes of the scene that is shown; all nodes without a parent if there is none
    /// What is said and not obeyed, with how often: "normalTexture of materials".
    std::map<std::string, int> ignored;
};

int gltf_size(GltfComponent component);

/// `file` names it in messages. Throws InputError, which says where ("meshes[2].primitives[0]"), for anything
/// that is not sound glTF 2.0, for extensions that are required and not known, and sparse accessors.
GltfDocument parse_gltf_json(std::string_view json, const std::string& file);

}  // namespace obscura
