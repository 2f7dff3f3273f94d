#include "lessons/stereo_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "core/parallel.h"
#include "core/topology.h"
#include "lessons/drawing/figure.h"
#include "raster/depth_map.h"
#include "raster/depth_tile.h"
#include "raster/surface.h"
#include "raster/view.h"
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

struct TileWork {
    SurfaceBlock block;
    alignas(64) float depth[frame_tile_side * frame_tile_side];
    alignas(64) std::uint32_t triangle[frame_tile_side * frame_tile_side];
};

SeenPicture empty_picture(int width, int height) {
    SeenPicture seen;
    seen.depth_m = Image<float>(width, height, std::numeric_limits<float>::infinity());
    seen.position = seen.normal = Image<Vec3f>(width, height);
    seen.triangle = Image<std::uint32_t>(width, height, nothing_seen);
    return seen;
}

/// Rows of a tile that the surface stage has been through.
void keep_block(const SurfaceBlock& b, const CameraRays& rays, int x0, int y0, SeenPicture& seen) {
    const Vec3d eye{rays.eye[0], rays.eye[1], rays.eye[2]};
    for (int i = 0; i < block_samples; ++i) {
        const int x = x0 + i % frame_tile_side, y = y0 + i / frame_tile_side;
        if (x >= seen.triangle.width || y >= seen.triangle.height || b.triangle[i] == no_triangle) continue;
        seen.depth_m(x, y) = view_distance(rays, b.depth[i]);
        seen.position(x, y) = to_float(eye) + Vec3f{b.px[i], b.py[i], b.pz[i]};
        seen.normal(x, y) = {b.nx[i], b.ny[i], b.nz[i]};
        seen.triangle(x, y) = b.triangle[i];
    }
}

/// `drawn`: the mesh where it is seen; `mesh`: where its surface is. Null `moved_to`: they are one.
SeenPicture seen_picture(const Mesh& mesh, const Mesh& drawn, const std::vector<Vec3f>* moved_to,
                         const Camera& camera, int width, int height, const Exec& exec) {
    const View view = camera_view(camera, width, height);
    const CameraRays rays = camera_rays(camera, width, height);
    RasterScratch scratch;
    setup_triangles(drawn, view, {}, exec, scratch.setup);
    bin_records(scratch.setup, {0, 0, width, height}, frame_tile_side, exec, scratch.bins);
    SurfaceTables tables;
    surface_tables(mesh, std::vector<Material>(1), exec, tables);
    SurfaceMesh surface = surface_mesh(mesh, tables);
    if (moved_to != nullptr) surface.seen = &moved_to->front().x;
    SeenPicture seen = empty_picture(width, height);
    const int columns = (width + frame_tile_side - 1) / frame_tile_side;
    const int rows = (height + frame_tile_side - 1) / frame_tile_side;
    parallel_for(static_cast<std::size_t>(columns * rows), exec, [&](std::size_t i) {
        const auto work = std::make_unique<TileWork>();
        const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
        const TileRect tile{column * frame_tile_side, row * frame_tile_side, frame_tile_side,
                            frame_tile_side};
        std::fill_n(work->depth, frame_tile_side * frame_tile_side, view.max_depth);
        std::fill_n(work->triangle, frame_tile_side * frame_tile_side, no_triangle);
        const auto list = scratch.bins.list(column, row);
        OBSCURA_DISPATCH(exec.isa, visibility_tile, scratch.setup.records.data(), list.data(), list.size(),
                         tile, work->depth, work->triangle);
        for (int y = 0; y < frame_tile_side; y += block_rows) {
            std::copy_n(work->depth + y * frame_tile_side, block_samples, work->block.depth);
            std::copy_n(work->triangle + y * frame_tile_side, block_samples, work->block.triangle);
            OBSCURA_DISPATCH(exec.isa, surface_block, surface, rays, tile, y, work->block);
            keep_block(work->block, rays, tile.x0, tile.y0 + y, seen);
        }
    });
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
    return seen_picture(mesh, mesh, nullptr, camera, width, height, exec);
}

SeenPicture seen_by_eye(const StereoScene& scene, const MovedMesh& moved, Eye eye, int width, int height,
                        const Exec& exec) {
    const std::vector<Vec3f> at = eye_positions(moved, scene.camera, height, scene.rig, eye);
    return seen_picture(moved.mesh, eye_mesh(moved, at, exec), &at, scene.camera, width, height, exec);
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
