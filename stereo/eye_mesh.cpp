#include "stereo/eye_mesh.h"

#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "core/scene.h"
#include "raster/view.h"

namespace obscura {
namespace {

/// The plane through a triangle. One without area has no direction; it covers no sample, whatever its plane.
Plane plane_through(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d n = normalize(cross(b - a, c - a));
    return {n, -(dot(n, a) + dot(n, b) + dot(n, c)) / 3.0};
}

}  // namespace

Mesh eye_mesh(const MovedMesh& moved, std::vector<Vec3f> positions, const Exec& exec) {
    CHECK(positions.size() == moved.mesh.positions.size());
    Mesh mesh = moved.mesh;
    mesh.positions = std::move(positions);
    mesh.face.resize(mesh.triangles.size());
    std::iota(mesh.face.begin(), mesh.face.end(), 0u);
    mesh.faces.resize(mesh.triangles.size());
    parallel_blocks(mesh.triangles.size(), 4096, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const auto& v = mesh.triangles[t].v;
            mesh.faces[t] = plane_through(to_double(mesh.positions[v[0]]), to_double(mesh.positions[v[1]]),
                                          to_double(mesh.positions[v[2]]));
        }
    });
    return mesh;
}

std::vector<Vec3f> eye_positions(const MovedMesh& moved, const Camera& camera, int picture_height,
                                 const StereoRig& rig, Eye eye) {
    CHECK(moved.change_px.size() == moved.mesh.positions.size());
    const DisparityLaw law = disparity_law(rig, camera, picture_height);
    const Basis basis = look_basis(camera.look_at - camera.eye, camera.up);
    const double half = eye == Eye::left ? 0.5 : -0.5;
    std::vector<Vec3f> positions(moved.mesh.positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        // Half of (scale / z - offset + change) * z / focal, multiplied out: no division by z, so that it
        // means something at and behind the camera, and triangles that reach there bend nowhere.
        const Vec3d p = to_double(moved.mesh.positions[v]);
        const double z = dot(p - camera.eye, basis.forward);
        const double shift_m = half * (rig.interaxial_m * (1.0 - z / rig.zero_parallax_m) +
                                       static_cast<double>(moved.change_px[v]) * z / law.focal_px);
        positions[v] = to_float(p + basis.right * shift_m);
    }
    return positions;
}

}  // namespace obscura
