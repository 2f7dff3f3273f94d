#pragma once
// Middle views of small meshes for the tests of moved meshes, by the rasterizer's own stages.

#include <limits>
#include <vector>

#include "core/mesh.h"
#include "core/scene.h"
#include "core/topology.h"
#include "raster/bin.h"
#include "raster/camera_rays.h"
#include "raster/depth_tile.h"
#include "raster/setup.h"
#include "raster/view.h"
#include "stereo/middle_view.h"
#include "stereo/stereo_rig.h"

namespace obscura::stereo_views {

/// Nearest triangle and depth per pixel of `mesh` as `view` sees it.
inline void rasterize(const Mesh& mesh, const View& view, Image<std::uint32_t>& triangle,
                      Image<float>& depth) {
    TriangleSetup setup;
    setup_triangles(mesh, view, {}, {Isa::ref, 1}, setup);
    TileBins bins;
    bin_records(setup, {0, 0, view.width, view.height}, depth_tile_side, {Isa::ref, 1}, bins);
    triangle = Image<std::uint32_t>(view.width, view.height, nothing_seen);
    depth = Image<float>(view.width, view.height, view.max_depth);
    std::vector<float> z(depth_tile_side * depth_tile_side);
    std::vector<std::uint32_t> ids(z.size());
    for (std::size_t i = 0; i < bins.tiles(); ++i) {
        std::fill(z.begin(), z.end(), view.max_depth);
        std::fill(ids.begin(), ids.end(), no_triangle);
        const TileRect tile = bins.rect(i);
        const auto list = bins.list(i);
        ref::visibility_tile(setup.records.data(), list.data(), list.size(), tile, z.data(), ids.data());
        for (int y = 0; y < tile.height && tile.y0 + y < view.height; ++y) {
            for (int x = 0; x < tile.width && tile.x0 + x < view.width; ++x) {
                const auto at = static_cast<std::size_t>(y * tile.width + x);
                triangle(tile.x0 + x, tile.y0 + y) = ids[at];
                depth(tile.x0 + x, tile.y0 + y) = z[at];
            }
        }
    }
}

inline MiddleView middle_view(const Mesh& mesh, const Camera& camera, int width, int height, int margin,
                              const StereoRig& rig) {
    MiddleView v;
    v.picture_width = width;
    v.picture_height = height;
    v.margin_px = margin;
    const int columns = width + 2 * margin;
    Image<float> z;
    rasterize(mesh, camera_view(camera, columns, height), v.triangle, z);
    v.depth_m = Image<float>(columns, height, std::numeric_limits<float>::infinity());
    v.normal = Image<Vec3f>(columns, height);
    v.object = v.material = Image<std::uint32_t>(columns, height, nothing_seen);
    const DisparityLaw law = disparity_law(rig, camera, height);
    v.disparity = Image<float>(columns, height, static_cast<float>(-law.offset));
    for (std::size_t i = 0; i < z.pixels.size(); ++i) {
        const std::uint32_t t = v.triangle.pixels[i];
        if (t == nothing_seen) continue;
        v.depth_m.pixels[i] = static_cast<float>(-camera.near_m) / z.pixels[i];
        const auto corner = [&](int k) { return to_double(mesh.positions[mesh.triangles[t].v[k]]); };
        Vec3d n = normalize(cross(corner(1) - corner(0), corner(2) - corner(0)));
        if (dot(n, corner(0) - camera.eye) > 0) n = -n;
        v.normal.pixels[i] = to_float(n);
        v.object.pixels[i] = mesh.object.empty() ? 0 : mesh.object[t];
        v.material.pixels[i] = 0;
        v.disparity.pixels[i] = law.at(static_cast<double>(v.depth_m.pixels[i]));
    }
    return v;
}

/// Adds `part` as an object of its own, or as more of the last one.
inline void add(Mesh& to, Mesh part, Vec3d at, bool new_object = true) {
    for (Vec3f& p : part.positions)
        p = to_float(to_double(p) + at);
    part.object.assign(part.triangles.size(), 0);
    part.objects = {{"", true}};
    part.material.assign(part.triangles.size(), 0);
    analyse_topology(part);
    const auto objects = static_cast<std::uint32_t>(to.objects.size());
    append_mesh(to, part);
    if (new_object || objects == 0) return;
    to.objects.pop_back();
    for (std::uint32_t& o : to.object)
        o = std::min(o, objects - 1);
}

/// A wall facing +Z, width x height metres around the origin, of columns x rows quads.
inline Mesh wall(double width, double height, int columns, int rows) {
    Mesh m;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            m.positions.push_back(
                to_float(Vec3d{width * (i - 0.5 * columns) / columns, height * (j - 0.5 * rows) / rows, 0}));
            m.normals.push_back({0, 0, 1});
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i);
            const auto b = a + static_cast<std::uint32_t>(columns) + 1;
            m.triangles.push_back({{a, a + 1, b + 1}});
            m.triangles.push_back({{a, b + 1, b}});
        }
    }
    return m;
}

}  // namespace obscura::stereo_views
