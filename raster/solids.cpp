#include "raster/solids.h"

#include <algorithm>
#include <cmath>

#include "core/num.h"
#include "core/topology.h"

namespace obscura {
namespace {

void include(Bounds& b, Vec3d p) {
    b.low = {std::min(b.low.x, p.x), std::min(b.low.y, p.y), std::min(b.low.z, p.z)};
    b.high = {std::max(b.high.x, p.x), std::max(b.high.y, p.y), std::max(b.high.z, p.z)};
}

/// Radius of a ball about the eye that holds everything up to the near rectangle.
double near_reach(const Camera& camera, int width, int height) {
    const double aspect = static_cast<double>(width) / height;
    if (camera.kind == CameraKind::orthographic) {
        return 0.5 * camera.height_m * std::sqrt(1.0 + aspect * aspect);
    }
    const double tangent = num::tan(0.5 * camera.vfov_deg * (num::pi / 180.0));
    return camera.near_m * std::sqrt(1.0 + tangent * tangent * (1.0 + aspect * aspect));
}

}  // namespace

Solids solids_of(const Mesh& mesh) {
    Solids solids;
    const std::vector<double> volumes = signed_volumes(mesh);
    std::vector<Bounds> bounds(mesh.components.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : mesh.triangles[t].v)
            include(bounds[mesh.component[t]], to_double(mesh.positions[v]));
    }
    solids.outward = true;
    for (std::size_t c = 0; c < mesh.components.size(); ++c) {
        if (!mesh.components[c].closed) continue;
        solids.outward = solids.outward && volumes[c] >= 0;
        solids.bounds.push_back(bounds[c]);
    }
    return solids;
}

bool sees_no_exits(const Solids& solids, const Camera& camera, int width, int height) {
    if (!solids.outward) return false;
    const double reach = near_reach(camera, width, height);
    const Vec3d e = camera.eye;
    return std::none_of(solids.bounds.begin(), solids.bounds.end(), [&](const Bounds& b) {
        return e.x + reach >= b.low.x && e.x - reach <= b.high.x && e.y + reach >= b.low.y &&
               e.y - reach <= b.high.y && e.z + reach >= b.low.z && e.z - reach <= b.high.z;
    });
}

}  // namespace obscura
