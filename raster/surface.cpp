#include "raster/surface.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace obscura {
namespace {

/// Corner normals this near to the face's own are taken for it: then nothing needs interpolating.
constexpr float flat_tolerance = 1e-4f;

bool differs(Vec3f a, Vec3f b) {
    return std::fabs(a.x - b.x) > flat_tolerance || std::fabs(a.y - b.y) > flat_tolerance ||
           std::fabs(a.z - b.z) > flat_tolerance;
}

}  // namespace

void surface_triangles(const Mesh& mesh, const std::vector<Material>& materials, const Exec& exec,
                       Buffer<SurfaceTriangle>& out) {
    CHECK(mesh.normals.size() == mesh.positions.size() && mesh.face.size() == mesh.triangles.size() &&
              mesh.component.size() == mesh.triangles.size(),
          "shading needs a mesh with topology and normals");
    CHECK(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
    CHECK(materials.size() < surface_material_mask && mesh.triangles.size() < 0x7fffffffu);
    out.reset(mesh.triangles.size());
    parallel_blocks(mesh.triangles.size(), 4096, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const Vec3f normal = to_float(mesh.faces[mesh.face[t]].n);
            const Material& material = materials.at(mesh.material[t]);
            std::uint32_t info = mesh.material[t];
            if (!mesh.components[mesh.component[t]].closed) info |= surface_open;
            for (const std::uint32_t v : mesh.triangles[t].v) {
                if (differs(mesh.normals[v], normal)) info |= surface_smooth;
            }
            if (material.texture >= 0 && !mesh.uvs.empty()) info |= surface_textured;
            if (material.translucency > 0) info |= surface_thin;
            out[t] = {{normal.x, normal.y, normal.z}, info};
        }
    });
}

SurfaceMesh surface_mesh(const Mesh& mesh, const Buffer<SurfaceTriangle>& surface) {
    static_assert(sizeof(Triangle) == 12 && sizeof(Vec3f) == 12 && sizeof(Vec2f) == 8);
    SurfaceMesh s;
    if (mesh.triangles.empty()) return s;
    s.surface = surface.data();
    s.corners = mesh.triangles.data()->v;
    s.positions = &mesh.positions.data()->x;
    s.normals = &mesh.normals.data()->x;
    s.uvs = mesh.uvs.empty() ? nullptr : &mesh.uvs.data()->x;
    return s;
}

}  // namespace obscura
