#include "lessons/stereo_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/topology.h"
#include "core/vec_arrays.h"
#include "lessons/drawing/figure.h"
#include "lessons/seen_surfaces.h"
#include "raster/camera_rays.h"
#include "raster/depth_tile.h"
#include "scenes/build.h"
#include "scenes/shapes.h"
#include "stereo/disparity.h"
#include "stereo/eye_mesh.h"

namespace obscura {
namespace {

void add_object(Mesh& mesh, const char* name, const Mesh& part, const Affine& move) {
    const std::size_t first = mesh.triangles.size();
    add_part(mesh, part, move);
    if (mesh.objects.empty() || mesh.objects.back().name != name) mesh.objects.push_back({name, true});
    mesh.object.resize(first);
    mesh.object.resize(mesh.triangles.size(), static_cast<std::uint32_t>(mesh.objects.size() - 1));
}

SeenPicture empty_picture(int width, int height) {
    SeenPicture seen;
    seen.depth_m = Image<float>(width, height, std::numeric_limits<float>::infinity());
    seen.position = seen.normal = Image<Vec3f>(width, height);
    seen.triangle = Image<std::uint32_t>(width, height, nothing_seen);
    return seen;
}

SeenPicture seen_picture(const SeenMesh& mesh, const Camera& camera, int width, int height,
                         const Exec& exec) {
    const CameraRays rays = camera_rays(camera, width, height);
    const Vec3d eye = vec(rays.eye);
    SeenPicture seen = empty_picture(width, height);
    std::size_t sample = 0;
    for (const SurfaceBlock& b : seen_surfaces(mesh, camera, width, height, exec)) {
        for (int i = 0; i < block_samples; ++i, ++sample) {
            const auto [x, y] = seen_pixel(sample, width);
            if (x >= width || y >= height || b.triangle[i] == no_triangle) continue;
            seen.depth_m(x, y) = view_distance(rays, b.depth[i]);
            seen.position(x, y) = to_float(eye) + Vec3f{b.px[i], b.py[i], b.pz[i]};
            seen.normal(x, y) = {b.nx[i], b.ny[i], b.nz[i]};
            seen.triangle(x, y) = b.triangle[i];
        }
    }
    return seen;
}

bool chequered(Vec3f p) {
    const auto cell = [](float a) { return static_cast<int>(std::floor(static_cast<double>(a) / 0.75)); };
    return ((cell(p.x) + cell(p.y + 0.01f) + cell(p.z)) & 1) != 0;
}

}  // namespace

StereoScene stereo_scene() {
    StereoScene scene;
    Mesh& mesh = scene.mesh;
    add_object(mesh, "wall", box({-12, -0.5, -7.8}, {12, 7, -7.6}), translation(0, 0, 0));
    add_object(mesh, "floor", plane(24, 7.6), translation(0, 0, -3.8));
    add_object(mesh, "block", box(Vec3d{0.95, 1.45, 0.95}), translation(-1.25, 0.725, -4) * rotation_y(30));
    add_object(mesh, "ball", sphere(1.0, 40, 20), translation(0.4, 1.0, -5.2));
    add_object(mesh, "bust", cylinder(0.16, 1.1, 24), translation(1.0, 0, -3));
    add_object(mesh, "bust", sphere(0.42, 32, 16), translation(1.0, 1.35, -3));
    analyse_topology(mesh);
    scene.camera.eye = {0, 1.5, 0};
    scene.camera.look_at = {0, 1.5, -1};
    scene.rig.interaxial_m = 0.3;
    scene.rig.zero_parallax_m = 4;
    return scene;
}

std::vector<std::string> object_names(const Mesh& mesh) {
    std::vector<std::string> names;
    for (const Object& object : mesh.objects)
        names.push_back(object.name);
    return names;
}

SeenPicture seen_from_middle(const Mesh& mesh, const Camera& camera, int width, int height,
                             const Exec& exec) {
    return seen_picture(SeenMesh(mesh), camera, width, height, exec);
}

SeenPicture seen_by_eye(const StereoScene& scene, const MovedMesh& moved, Eye eye, int width, int height,
                        const Exec& exec) {
    const std::vector<Vec3f> at = eye_positions(moved, scene.camera, height, scene.rig, eye);
    const Mesh drawn = eye_mesh(moved, at, exec);
    return seen_picture({moved.mesh, drawn, at}, scene.camera, width, height, exec);
}

Image<Rgb8> shaded(const Mesh& mesh, const SeenPicture& seen) {
    constexpr Rgb8 paints[] = {
        {196, 190, 178}, {168, 160, 148}, {86, 150, 190}, {214, 120, 60}, {96, 160, 120}};
    const Vec3f light = to_float(normalize(Vec3d{-0.45, 0.65, 0.6}));
    Image<Rgb8> picture(seen.triangle.width, seen.triangle.height, ink::dark);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (seen.triangle.pixels[i] == nothing_seen) continue;
        const std::uint32_t object = mesh.object[seen.triangle.pixels[i]];
        double shade = 0.45 + 0.55 * std::max(0.0, static_cast<double>(dot(seen.normal.pixels[i], light)));
        if (object <= stereo_object::ground && chequered(seen.position.pixels[i])) shade *= 0.86;
        picture.pixels[i] = mix({0, 0, 0}, paints[object], shade);
    }
    return picture;
}

MiddleView stereo_view(const StereoScene& scene, const SeenPicture& seen) {
    MiddleView view;
    view.picture_width = seen.depth_m.width;
    view.picture_height = seen.depth_m.height;
    view.depth_m = seen.depth_m;
    view.normal = seen.normal;
    view.triangle = seen.triangle;
    view.object = Image<std::uint32_t>(view.picture_width, view.picture_height, nothing_seen);
    for (std::size_t i = 0; i < view.object.pixels.size(); ++i) {
        if (seen.triangle.pixels[i] != nothing_seen)
            view.object.pixels[i] = scene.mesh.object[seen.triangle.pixels[i]];
    }
    view.material = view.object;
    view.disparity =
        disparity_map(view.depth_m, disparity_law(scene.rig, scene.camera, view.picture_height), {});
    return view;
}

MiddleView stereo_view(const StereoScene& scene, int width, int height, const Exec& exec) {
    return stereo_view(scene, seen_from_middle(scene.mesh, scene.camera, width, height, exec));
}

MovedMesh unmoved(const Mesh& mesh) {
    MovedMesh moved;
    moved.mesh = mesh;
    moved.source.resize(mesh.triangles.size());
    std::iota(moved.source.begin(), moved.source.end(), 0u);
    moved.change_px.assign(mesh.positions.size(), 0.0f);
    return moved;
}

}  // namespace obscura
