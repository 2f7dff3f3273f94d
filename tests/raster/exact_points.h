#pragma once
// Points on drawn meshes, in the form that exact shadows ask for.

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "raster/camera_rays.h"
#include "raster/exact/exact.h"
#include "tests/raster/exact_scenes.h"

namespace obscura::exact_scenes {

/// Points on a mesh, in the form that exact shadows ask for.
struct Points {
    std::vector<double> p[3];
    std::vector<float> g[3];
    std::vector<std::uint32_t> face, triangle, covered, thin;

    void add(Vec3d at, Vec3f normal, std::uint32_t face_id, std::uint32_t triangle_id, bool is_thin) {
        const std::size_t i = face.size();
        for (int k = 0; k < 3; ++k) {
            p[k].push_back(k == 0 ? at.x : k == 1 ? at.y : at.z);
            g[k].push_back(k == 0 ? normal.x : k == 1 ? normal.y : normal.z);
        }
        face.push_back(face_id);
        triangle.push_back(triangle_id);
        if (i % 16 == 0) {
            covered.push_back(0);
            thin.push_back(0);
        }
        covered.back() |= 1u << i % 16;
        thin.back() |= is_thin ? 1u << i % 16 : 0u;
    }
    void fill_up() {
        while (face.size() % 16 != 0) {
            for (int k = 0; k < 3; ++k) {
                p[k].push_back(0);
                g[k].push_back(0);
            }
            face.push_back(0);
            triangle.push_back(0);
        }
    }
    ExactPoints view() const {
        return {static_cast<std::int32_t>(face.size()),
                p[0].data(),
                p[1].data(),
                p[2].data(),
                g[0].data(),
                g[1].data(),
                g[2].data(),
                face.data(),
                triangle.data(),
                covered.data(),
                thin.data()};
    }
    int count() const {
        int n = 0;
        for (const std::uint32_t word : covered)
            n += __builtin_popcount(word);
        return n;
    }
};

/// A camera's rays, as far as exact shadows ask: where the eye is, and how large a pixel.
inline CameraRays rays_from(Vec3d eye, double pixel) {
    CameraRays rays{};
    rays.perspective = true;
    rays.eye[0] = eye.x;
    rays.eye[1] = eye.y;
    rays.eye[2] = eye.z;
    rays.dir_x[0] = rays.dir_y[1] = pixel;
    return rays;
}

inline Points draw_points(Source& source, const Mesh& mesh, Vec3d eye, int count) {
    Points points;
    for (int i = 0; i < count; ++i) {
        const auto t = static_cast<std::size_t>(source.below(static_cast<int>(mesh.triangles.size())));
        const Triangle& tri = mesh.triangles[t];
        const Vec3d a = to_double(mesh.positions[tri.v[0]]), b = to_double(mesh.positions[tri.v[1]]),
                    c = to_double(mesh.positions[tri.v[2]]);
        double u = source.between(0, 1), v = source.between(0, 1);
        if (source.below(4) == 0) u = source.below(2);  // on an edge, or a corner
        if (source.below(4) == 0) v = source.below(2);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        // What a camera snaps beside its triangle.
        if (source.below(6) == 0) u -= 1e-3 * source.between(0, 1);
        const Vec3f seen = to_float(a + (b - a) * u + (c - a) * v - eye);
        const Plane& plane = mesh.faces[mesh.face[t]];
        const Vec3d near = eye + to_double(seen), p = near - plane.n * (dot(plane.n, near) + plane.d);
        Vec3f n = to_float(plane.n);
        if (dot(n, seen) > 0) n = -n;
        points.add(p, n, mesh.face[t], static_cast<std::uint32_t>(t), source.below(8) == 0);
    }
    points.fill_up();
    return points;
}

}  // namespace obscura::exact_scenes
