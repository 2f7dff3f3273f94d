#include "stereo/moved_mesh.h"

#include <algorithm>

#include "core/edges.h"
#include "core/error.h"
#include "stereo/hidden_change.h"
#include "stereo/refine.h"

namespace obscura {
namespace {

/// Attributes of the vertices that cuts added, each from two that came before.
void add_vertices(const Bisection& surface, Mesh& mesh) {
    const std::size_t count = mesh.positions.size() + surface.vertices.size();
    mesh.positions.reserve(count);
    mesh.normals.reserve(mesh.normals.empty() ? 0 : count);
    mesh.uvs.reserve(mesh.uvs.empty() ? 0 : count);
    for (const MidVertex& v : surface.vertices) {
        mesh.positions.push_back(surface.points[v.point].position);
        if (!mesh.normals.empty()) {
            const Vec3f a = mesh.normals[v.a], b = mesh.normals[v.b];
            mesh.normals.push_back(normalize(a + (b - a) * v.share, a));
        }
        if (!mesh.uvs.empty()) {
            const Vec2f a = mesh.uvs[v.a], b = mesh.uvs[v.b];
            mesh.uvs.push_back(a + (b - a) * v.share);
        }
    }
}

template <class T>
void inherit(const std::vector<std::uint32_t>& source, std::vector<T>& per_triangle) {
    if (per_triangle.empty()) return;
    const std::size_t before = per_triangle.size();
    per_triangle.resize(source.size());
    for (std::size_t t = before; t < source.size(); ++t)
        per_triangle[t] = per_triangle[source[t]];
}

MovedMesh assembled(const Mesh& mesh, const Bisection& surface) {
    MovedMesh moved;
    moved.mesh = mesh;
    add_vertices(surface, moved.mesh);
    moved.mesh.triangles.resize(surface.triangles.size());
    moved.source.resize(surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const FineTriangle& f = surface.triangles[t];
        moved.mesh.triangles[t] = {{f.vertex[0], f.vertex[1], f.vertex[2]}};
        moved.source[t] = f.source;
        if (t >= mesh.triangles.size()) ++moved.mesh.components[mesh.component[f.source]].triangles;
    }
    inherit(moved.source, moved.mesh.material);
    inherit(moved.source, moved.mesh.object);
    inherit(moved.source, moved.mesh.component);
    inherit(moved.source, moved.mesh.face);
    moved.change_px.reserve(moved.mesh.positions.size());
    for (const std::uint32_t p : surface.point_of_vertex)
        moved.change_px.push_back(surface.points[p].change_px);
    for (const MidVertex& v : surface.vertices)
        moved.change_px.push_back(surface.points[v.point].change_px);
    return moved;
}

}  // namespace

MovedMesh moved_mesh(const Mesh& mesh, const Camera& camera, const MiddleView& view,
                     const DisparityMap& optimised, const ReprojectParams& params, const Exec& exec,
                     ReprojectStats& stats) {
    CHECK(params.tolerance_px > 0 && params.max_splits >= 0);
    stats = {};
    const SeenChange seen = seen_change(mesh, camera, view, optimised, params.radius_px, exec);
    SurfacePoints vertices = surface_points(mesh, seen.projection, exec);
    const std::vector<Triangle> triangles = relabel(mesh.triangles, vertices.of_vertex);
    TrianglePixels pixels = triangle_pixels(view.triangle, triangles.size());
    gather_seen(seen, exec, vertices.points);
    fill_hidden(seen, triangles, pixels, exec, vertices.points);
    // Each of two neighbours may miss by the tolerance.
    join_touching(mesh, 2 * params.tolerance_px, vertices);

    Bisection surface(mesh, seen.projection, std::move(vertices), std::move(pixels));
    refine(seen, params, exec, surface, stats);

    stats.triangles_in = static_cast<std::int64_t>(mesh.triangles.size());
    stats.vertices_seen = std::count_if(surface.points.begin(), surface.points.end(),
                                        [](const SurfacePoint& p) { return p.seen; });
    stats.vertices_hidden = static_cast<std::int64_t>(surface.points.size()) - stats.vertices_seen;
    return assembled(mesh, surface);
}

}  // namespace obscura
