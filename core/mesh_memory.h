#pragma once
// What meshes take.

#include <cstdint>

#include "core/mesh.h"

namespace obscura {

/// Numbers that memory grows with.
struct MeshSize {
    std::int64_t vertices = 0, triangles = 0, faces = 0;
};

inline MeshSize size_of(const Mesh& mesh) {
    return {static_cast<std::int64_t>(mesh.positions.size()),
            static_cast<std::int64_t>(mesh.triangles.size()), static_cast<std::int64_t>(mesh.faces.size())};
}

constexpr std::int64_t mesh_vertex_bytes = 2 * sizeof(Vec3f) + sizeof(Vec2f);
/// Corners, four numbers (material, object, component, face) and a face's plane, which few triangles share.
constexpr std::int64_t mesh_triangle_bytes = sizeof(Triangle) + 4 * sizeof(std::uint32_t) + sizeof(Plane);

constexpr std::int64_t mesh_bytes(const MeshSize& mesh) {
    return mesh.vertices * mesh_vertex_bytes + mesh.triangles * mesh_triangle_bytes;
}

}  // namespace obscura
