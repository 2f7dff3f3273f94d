#include "raster/surface.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/topology.h"

namespace obscura {
namespace {

/// Corner normals this near to the face's own are taken for it: then nothing needs interpolating.
constexpr float flat_tolerance = 1e-4f;

bool differs(Vec3f a, Vec3f b) {
    return std::fabs(a.x - b.x) > flat_tolerance || std::fabs(a.y - b.y) > flat_tolerance ||
           std::fabs(a.z - b.z) > flat_tolerance;
}

}  // namespace

void surface_tables(const Mesh& mesh, const std::vector<Material>& materials, const Exec& exec,
                    SurfaceTables& out) {
    CHECK(mesh.normals.size() == mesh.positions.size() && mesh.face.size() == mesh.triangles.size() &&
              mesh.component.size() == mesh.triangles.size(),
          "shading needs a mesh with topology and normals");
    CHECK(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
    CHECK(materials.size() < surface_material_mask && mesh.triangles.size() < 0x7fffffffu);
    const std::vector<double> volume = signed_volumes(mesh);
    out.triangles.reset(mesh.triangles.size());
    parallel_blocks(mesh.triangles.size(), 4096, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const Vec3f normal = to_float(mesh.faces[mesh.face[t]].n);
            const Material& material = materials.at(mesh.material[t]);
            std::uint32_t info = mesh.material[t];
            const std::uint32_t component = mesh.component[t];
            if (!mesh.components[component].closed || volume[component] < 0) info |= surface_open;
            for (const std::uint32_t v : mesh.triangles[t].v) {
                if (differs(mesh.normals[v], normal)) info |= surface_smooth;
            }
            if (material.texture >= 0 && !mesh.uvs.empty()) info |= surface_textured;
            if (material.translucency > 0) info |= surface_thin;
            out.triangles[t] = {{normal.x, normal.y, normal.z}, info};
        }
    });
    out.vertices.reset(mesh.positions.size());
    parallel_blocks(mesh.positions.size(), 8192, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const Vec3f p = mesh.positions[v], n = mesh.normals[v];
            const Vec2f uv = mesh.uvs.empty() ? Vec2f{} : mesh.uvs[v];
            out.vertices[v] = {{p.x, p.y, p.z}, {n.x, n.y, n.z}, {uv.x, uv.y}};
        }
    });
}

SurfaceMesh surface_mesh(const Mesh& mesh, const SurfaceTables& tables) {
    static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t));
    if (mesh.triangles.empty()) return {};
    return {tables.triangles.data(), tables.vertices.data(), mesh.triangles.data()->v};
}

}  // namespace obscura
