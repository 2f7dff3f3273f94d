#include "bench/bench_scenes.h"

#include <algorithm>

#include "bench/views.h"
#include "core/error.h"

namespace obscura {
namespace {

struct Box {
    Vec3d min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300};
};

void extend(Box& box, Vec3d p) {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
}

Box bounds_of(const Mesh& mesh) {
    CHECK(!mesh.positions.empty());
    Box box;
    for (const Vec3f p : mesh.positions)
        extend(box, to_double(p));
    return box;
}

/// Orthographic map over everything the light sees, the same scale along both sides.
LightView light_view(const Mesh& mesh, Vec3d direction, int resolution) {
    const Vec3d right = normalize(cross(direction, Vec3d{0, 1, 0}));
    const Vec3d down = cross(direction, right);
    Box box;
    for (const Vec3f position : mesh.positions) {
        const Vec3d p = to_double(position);
        extend(box, {dot(right, p), dot(down, p), dot(direction, p)});
    }
    const Vec3d size = box.max - box.min, middle = (box.max + box.min) * 0.5;
    const double scale = resolution / (1.01 * std::max(size.x, size.y));
    const double depth_scale = 1.0 / (1.01 * size.z);
    const auto row = [&](Vec3d axis, double s, double centre, double at) {
        return Vec4d{axis.x * s, axis.y * s, axis.z * s, at - centre * s};
    };
    const Vec4d x = row(right, scale, middle.x, 0.5 * resolution),
                y = row(down, scale, middle.y, 0.5 * resolution);
    const Vec4d z = row(direction, depth_scale, middle.z, 0.5);
    LightView view;
    view.to_map = Mat4{{{x.x, x.y, x.z, x.w}, {y.x, y.y, y.z, y.w}, {z.x, z.y, z.z, z.w}, {0, 0, 0, 1}}};
    view.width = view.height = resolution;
    return view;
}

/// A three-quarter view from above that the scene fills.
Camera camera_over(const Box& box) {
    const Vec3d size = box.max - box.min, middle = (box.max + box.min) * 0.5;
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
    scene.materials = {Material{}};
    scene.camera = camera_over(bounds_of(scene.mesh));
    scene.render = {size.frame_width, size.frame_height, 1, 0.0, ToneCurve::linear, Receivers::any};
    scene.sky.visible = false;

    Light sun;
    sun.id = "sun";
    sun.direction = normalize(Vec3d{-0.55, -0.75, -0.35});
    sun.color = {1.8f, 1.8f, 1.8f};  // keeps Phong below 1: llvmpipe paints 8-bit pictures
    sun.shadow.resolution = size.map_px;
    sun.shadow.filter_px = 1;
    scene.lights = {sun};
    bench.light = light_view(scene.mesh, sun.direction, size.map_px);
    return bench;
}

double view_distance_m(const BenchScene& bench) {
    const Box box = bounds_of(bench.scene.mesh);
    const Vec3d eye = bench.scene.camera.eye;
    const auto farther = [](double e, double lo, double hi) {
        return std::max(std::abs(lo - e), std::abs(hi - e));
    };
    return length(Vec3d{farther(eye.x, box.min.x, box.max.x), farther(eye.y, box.min.y, box.max.y),
                        farther(eye.z, box.min.z, box.max.z)});
}

}  // namespace obscura
