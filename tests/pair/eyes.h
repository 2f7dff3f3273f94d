#pragma once
// Eyes of unedited scenes, without help from a disparity map.

#include <functional>
#include <numeric>

#include "app/pair/eyes.h"
#include "raster/view.h"
#include "tests/frame/scenes.h"

namespace obscura::stereo_eyes {

/// The scene's own triangles.
inline MovedMesh unrefined(const Scene& scene) {
    MovedMesh moved;
    moved.mesh = scene.mesh;
    moved.source.resize(scene.mesh.triangles.size());
    std::iota(moved.source.begin(), moved.source.end(), 0u);
    moved.change_px.assign(scene.mesh.positions.size(), 0.0f);
    return moved;
}

/// Distance along the view axis.
inline double axis_distance(const Camera& camera, Vec3d p) {
    return dot(p - camera.eye, look_basis(camera.look_at - camera.eye, camera.up).forward);
}

/// A rig for which things at infinity have exactly minus this disparity.
inline StereoRig rig_with_offset(const Scene& scene, double interaxial_m, double offset_px) {
    StereoRig rig;
    rig.interaxial_m = interaxial_m;
    rig.zero_parallax_m = disparity_law(rig, scene.camera, scene.render.height).scale / offset_px;
    return rig;
}

/// Where an eye sees vertices whose disparity is law + change(vertex).
inline std::vector<Vec3f> positions_of(const Scene& scene, const StereoRig& rig, Eye eye,
                                       const std::function<double(std::size_t)>& change) {
    const Camera& camera = scene.camera;
    const DisparityLaw law = disparity_law(rig, camera, scene.render.height);
    const Vec3d right = look_basis(camera.look_at - camera.eye, camera.up).right;
    std::vector<Vec3f> seen;
    for (std::size_t v = 0; v < scene.mesh.positions.size(); ++v) {
        const Vec3d p = to_double(scene.mesh.positions[v]);
        const double z = axis_distance(camera, p);
        const double disparity_z = law.scale + (change(v) - law.offset) * z;  // linear in z, behind too
        const double half = (eye == Eye::left ? 0.5 : -0.5) * disparity_z / law.focal_px;
        seen.push_back(to_float(p + right * half));
    }
    return seen;
}

inline EyePositions unedited(const Scene& scene, const StereoRig& rig) {
    const auto none = [](std::size_t) { return 0.0; };
    return {positions_of(scene, rig, Eye::left, none), positions_of(scene, rig, Eye::right, none)};
}

/// The scene with its camera moved to an eye and its picture widened by `more` columns on either side.
inline Scene beside(const Scene& scene, const StereoRig& rig, Eye eye, int more) {
    Scene s = scene;
    const Vec3d right = look_basis(scene.camera.look_at - scene.camera.eye, scene.camera.up).right;
    const Vec3d step = right * ((eye == Eye::left ? -0.5 : 0.5) * rig.interaxial_m);
    s.camera.eye = s.camera.eye + step;
    s.camera.look_at = s.camera.look_at + step;
    s.render.width += 2 * more;
    return s;
}

/// One eye, ready for tiles.
struct OneEye {
    OneEye(const Scene& scene, const StereoRig& rig, Eye eye, std::vector<Vec3f> seen)
        : moved(unrefined(scene)) {
        surface_tables(moved.mesh, scene.materials, {}, tables);
        stage.seen = std::move(seen);
        tiles = eye_tiles(scene, moved, tables, rig, eye, {}, stage);
    }
    MovedMesh moved;
    SurfaceTables tables;
    EyeStage stage;
    TileScene tiles;
};

}  // namespace obscura::stereo_eyes
