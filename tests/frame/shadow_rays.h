#pragma once
// The shadow channel of a picture against rays to the light, in double, one triangle at a time.

#include <cmath>

#include "tests/frame/scenes.h"

namespace obscura::frame_scenes {

inline bool hits(const Mesh& mesh, const Triangle& t, Vec3d o, Vec3d d, double limit) {
    const Vec3d a = to_double(mesh.positions[t.v[0]]), e1 = to_double(mesh.positions[t.v[1]]) - a,
                e2 = to_double(mesh.positions[t.v[2]]) - a;
    const Vec3d p = cross(d, e2);
    const double det = dot(e1, p);
    if (det == 0) return false;
    const double inv = 1 / det;
    const Vec3d s = o - a;
    const double u = dot(s, p) * inv;
    if (u < 0 || u > 1) return false;
    const Vec3d q = cross(s, e1);
    const double v = dot(d, q) * inv;
    if (v < 0 || u + v > 1) return false;
    const double hit = dot(e2, q) * inv;
    return hit > 1e-9 && hit < limit;
}

/// Surfaces between the point and the light.
inline int crossings(const Mesh& mesh, Vec3d point, const Light& light) {
    const bool far = light.kind == LightKind::directional;
    const Vec3d to = far ? -light.direction : light.position - point;
    int count = 0;
    for (const Triangle& t : mesh.triangles)
        count += hits(mesh, t, point, to, far ? 1e30 : 1.0);
    return count;
}

/// Whether the surface goes on below the point: something within 3 cm along -n.
inline bool stands_on_surface(const Mesh& mesh, Vec3d point, Vec3d n) {
    for (const Triangle& t : mesh.triangles) {
        if (hits(mesh, t, point, -n, 0.03)) return true;
    }
    return false;
}

struct RayCount {
    int lit = 0, dark = 0;    ///< pixels whose whole surroundings are lit, dark
    int acne = 0, leaks = 0;  ///< of these, not fully lit, not fully dark
};

/// Compares the picture's shadow channel to rays, wherever all rays within `margin_m` around a pixel agree
/// and start on the same surface. A map cannot do better than its texels: at an edge where light grazes past
/// a solid its interval thins out to nothing, and where solids touch it spans both of them.
inline RayCount compare_with_rays(const Scene& scene, double margin_m) {
    const Frame frame = render_frame(scene, all_channels());
    const CameraRays rays = camera_rays(scene.camera, scene.render.width, scene.render.height);
    const Light& light = scene.lights[0].light;
    const bool closed = scene.mesh.components[0].closed;
    RayCount count;
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            if (std::isinf(frame.depth_m(x, y))) continue;
            const auto along = [&](int k) {
                const double dir = rays.dir0[k] + (x + 0.5) * rays.dir_x[k] + (y + 0.5) * rays.dir_y[k];
                return rays.eye[k] + dir * static_cast<double>(frame.depth_m(x, y));
            };
            const Vec3d p{along(0), along(1), along(2)};
            const Vec3d n = to_double(frame.normal(x, y));
            const Vec3d l =
                light.kind == LightKind::directional ? -light.direction : normalize(light.position - p);
            // Near the terminator of a faceted sphere, facets and normals disagree about the side.
            if (std::fabs(dot(n, l)) < 0.3) continue;
            if (dot(n, l) < 0) {
                ++count.dark;
                count.leaks += frame.shadow(x, y) != 0.0f;
                continue;
            }
            const Basis tangent = look_basis(n, {0.3, 0.9, 0.2});
            int dark = 0;
            bool inner = true;
            for (int k = 0; k < 9; ++k) {
                const Vec3d at = p + n * 1e-3 + tangent.right * (margin_m * (k % 3 - 1)) +
                                 tangent.up * (margin_m * (k / 3 - 1));
                const int met = crossings(scene.mesh, at, light);
                dark += met > 0;
                const bool inside_solid = closed && met % 2 == 1;
                inner = inner && !inside_solid && stands_on_surface(scene.mesh, at, n);
            }
            if (!inner) continue;
            if (dark == 0) {
                ++count.lit;
                count.acne += frame.shadow(x, y) != 1.0f;
            } else if (dark == 9) {
                ++count.dark;
                count.leaks += frame.shadow(x, y) != 0.0f;
            }
        }
    }
    return count;
}

}  // namespace obscura::frame_scenes
