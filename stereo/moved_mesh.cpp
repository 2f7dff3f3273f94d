#include "stereo/moved_mesh.h"

#include <algorithm>
#include <numeric>

#include "core/edges.h"
#include "core/error.h"
#include "stereo/hidden_change.h"
#include "stereo/surface_points.h"
#include "stereo/triangle_pixels.h"
#include "stereo/vertex_gather.h"

namespace obscura {

MovedMesh moved_mesh(const Mesh& mesh, const Camera& camera, const MiddleView& view,
                     const DisparityMap& optimised, const ReprojectParams& params, const Exec& exec,
                     ReprojectStats& stats) {
    stats = {};
    const SeenChange seen = seen_change(mesh, camera, view, optimised, params.radius_px, exec);
    SurfacePoints surface = surface_points(mesh, seen.projection, exec);
    const std::vector<Triangle> triangles = relabel(mesh.triangles, surface.of_vertex);
    const TrianglePixels pixels = triangle_pixels(view.triangle, triangles.size());
    gather_seen(seen, exec, surface.points);
    fill_hidden(seen, triangles, pixels, exec, surface.points);

    MovedMesh moved;
    moved.mesh = mesh;
    moved.source = all_indices(mesh.triangles.size());
    moved.change_px.resize(mesh.positions.size());
    for (std::size_t v = 0; v < moved.change_px.size(); ++v)
        moved.change_px[v] = surface.points[surface.of_vertex[v]].change_px;
    stats.triangles_in = stats.triangles_out = static_cast<std::int64_t>(mesh.triangles.size());
    stats.vertices_seen = std::count_if(surface.points.begin(), surface.points.end(),
                                        [](const SurfacePoint& p) { return p.seen; });
    stats.vertices_hidden = static_cast<std::int64_t>(surface.points.size()) - stats.vertices_seen;
    return moved;
}

}  // namespace obscura
