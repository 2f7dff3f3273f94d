#include "bench/harness/stage.h"

#include <algorithm>

#include "bench/harness/run_times.h"
#include "core/topology.h"
#include "raster/view.h"

namespace obscura {
namespace {

/// A three-quarter view from above that the scene fills.
Camera camera_over(const Bounds& box) {
    const Vec3d size = box.high - box.low, middle = (box.high + box.low) * 0.5;
    const double reach = std::max(size.x, size.z);
    Camera camera;
    camera.look_at = middle - Vec3d{0, 0.35 * size.y, 0};
    camera.eye = camera.look_at + Vec3d{0.35, 0.55, 0.75} * reach;
    camera.vfov_deg = 40;
    camera.near_m = 0.01 * reach;
    return camera;
}

}  // namespace

BenchScene stage_scene(std::string name, Mesh mesh, const BenchSize& size) {
    BenchScene bench;
    bench.name = std::move(name);
    Scene& scene = bench.scene;
    scene.mesh = std::move(mesh);
    scene.mesh.material.assign(scene.mesh.triangles.size(), 0);
    if (scene.mesh.objects.empty()) scene.mesh.objects = {{"all", true}};
    bench.topology_ms = milliseconds_of([&] { analyse_topology(scene.mesh); });
    scene.materials = {Material{}};
    scene.camera = camera_over(bounds_of(scene.mesh));
    scene.render = {size.frame_width, size.frame_height, 1, 0.0, ToneCurve::linear, Receivers::any};
    scene.sky.visible = false;

    SceneLight sun;
    sun.light.id = "sun";
    sun.light.direction = normalize(Vec3d{-0.137, -0.848, -0.512});  // its map is about half full
    sun.light.color = {1.8f, 1.8f, 1.8f};  // keeps Phong below 1: llvmpipe paints 8-bit pictures
    sun.shadow.method = ShadowMethod::map;
    sun.shadow.resolution = size.map_px;
    sun.shadow.filter_px = 1;
    scene.lights = {sun};
    bench.light = orthographic_light_view(bounds_of(scene.mesh), sun.light.direction, size.map_px);
    return bench;
}

double view_distance_m(const BenchScene& bench) {
    const Bounds box = bounds_of(bench.scene.mesh);
    const Vec3d eye = bench.scene.camera.eye;
    const auto farther = [](double e, double lo, double hi) {
        return std::max(std::abs(lo - e), std::abs(hi - e));
    };
    return length(Vec3d{farther(eye.x, box.low.x, box.high.x), farther(eye.y, box.low.y, box.high.y),
                        farther(eye.z, box.low.z, box.high.z)});
}

}  // namespace obscura
