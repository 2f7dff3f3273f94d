#include "raster/view.h"

#include <algorithm>
#include <cmath>

#include "core/num.h"

namespace obscura {
namespace {

constexpr double radians = 3.14159265358979323846 / 180.0;

/// Rows of a map with X = sx * right + ox, Y = sy * up + oy, in a frame around `eye`.
struct Frame {
    Basis basis;
    Vec3d eye;
    Vec4d row(Vec3d axis, double scale) const {
        return {axis.x * scale, axis.y * scale, axis.z * scale, -dot(axis, eye) * scale};
    }
};

void set_row(Mat4& m, int r, Vec4d v) {
    m.m[r][0] = v.x;
    m.m[r][1] = v.y;
    m.m[r][2] = v.z;
    m.m[r][3] = v.w;
}

Vec4d sum(Vec4d a, Vec4d b, double s) {
    return {a.x + b.x * s, a.y + b.y * s, a.z + b.z * s, a.w + b.w * s};
}

/// Perspective map: texels per unit of tangent `fx`, image centre (cx, cy), depth row = zw * w + z1.
View perspective_view(const Frame& frame, double texels_per_tangent, int width, int height) {
    View view;
    view.width = width;
    view.height = height;
    view.perspective = true;
    const Vec4d w = frame.row(frame.basis.forward, 1.0);
    set_row(view.to_map, 0, sum(frame.row(frame.basis.right, texels_per_tangent), w, 0.5 * width));
    set_row(view.to_map, 1, sum(frame.row(frame.basis.up, -texels_per_tangent), w, 0.5 * height));
    set_row(view.to_map, 3, w);
    return view;
}

/// Orthographic map of resolution x resolution texels around frame.eye; depths within `depth_reach` metres of
/// it, before and behind, lie in [0, 1].
LightView parallel_view(const Frame& frame, double x_texels_per_m, double y_texels_per_m, double depth_reach,
                        int resolution) {
    LightView view;
    view.width = view.height = resolution;
    Vec4d x = frame.row(frame.basis.right, x_texels_per_m), y = frame.row(frame.basis.up, -y_texels_per_m);
    Vec4d z = frame.row(frame.basis.forward, 0.5 / depth_reach);
    x.w += 0.5 * resolution;
    y.w += 0.5 * resolution;
    z.w += 0.5;
    set_row(view.to_map, 0, x);
    set_row(view.to_map, 1, y);
    set_row(view.to_map, 2, z);
    return view;
}

}  // namespace

Bounds bounds_of(const Mesh& mesh) {
    Bounds b;
    for (const Vec3f& p : mesh.positions) {
        const Vec3d d = to_double(p);
        b.low = {std::min(b.low.x, d.x), std::min(b.low.y, d.y), std::min(b.low.z, d.z)};
        b.high = {std::max(b.high.x, d.x), std::max(b.high.y, d.y), std::max(b.high.z, d.z)};
    }
    return b;
}

Basis look_basis(Vec3d forward, Vec3d up) {
    Basis basis;
    basis.forward = normalize(forward, Vec3d{0, 0, -1});
    Vec3d right = cross(basis.forward, up);
    if (dot(right, right) < 1e-12 * dot(up, up)) {
        right = cross(basis.forward, std::fabs(basis.forward.y) > 0.9 ? Vec3d{0, 0, -1} : Vec3d{0, 1, 0});
    }
    basis.right = normalize(right);
    basis.up = cross(basis.right, basis.forward);
    return basis;
}

LightView orthographic_light_view(const Bounds& bounds, Vec3d direction, int resolution) {
    const Basis basis = look_basis(direction, {0, 1, 0});
    // Extent of the box along the three axes of the light.
    const Vec3d centre = (bounds.low + bounds.high) * 0.5;
    const Vec3d half = (bounds.high - bounds.low) * 0.5;
    const auto reach = [&](Vec3d axis) {
        return std::fabs(axis.x) * half.x + std::fabs(axis.y) * half.y + std::fabs(axis.z) * half.z;
    };
    const double depth_reach = std::max(reach(basis.forward) * 1.0005, 1e-6);
    const double side_reach = std::max({reach(basis.right), reach(basis.up), 1e-6});
    // One texel of margin on every side, so that what lies on the box's border is sampled.
    const double texels_per_m = (resolution - 2) / (2.0 * side_reach);

    return parallel_view({basis, centre}, texels_per_m, texels_per_m, depth_reach, resolution);
}

Bounds caster_box(const Mesh& mesh, Vec3d direction) {
    const Basis basis = look_basis(direction, {0, 1, 0});
    std::vector<char> casts(mesh.positions.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!mesh.objects.empty() && !mesh.objects[mesh.object[t]].casts_shadow) continue;
        for (const std::uint32_t v : mesh.triangles[t].v)
            casts[v] = 1;
    }
    Bounds box;
    for (std::size_t v = 0; v < casts.size(); ++v) {
        if (casts[v] == 0) continue;
        const Vec3d p = to_double(mesh.positions[v]);
        const Vec3d q{dot(basis.right, p), dot(basis.up, p), dot(basis.forward, p)};
        box.low = {std::min(box.low.x, q.x), std::min(box.low.y, q.y), std::min(box.low.z, q.z)};
        box.high = {std::max(box.high.x, q.x), std::max(box.high.y, q.y), std::max(box.high.z, q.z)};
    }
    return box;
}

LightView fitted_light_view(const Bounds& box, Vec3d direction, int resolution) {
    const Basis basis = look_basis(direction, {0, 1, 0});
    const Bounds b = box.empty() ? Bounds{{0, 0, 0}, {0, 0, 0}} : box;
    const Vec3d centre = (b.low + b.high) * 0.5, half = (b.high - b.low) * 0.5;
    // A side that is next to nothing, as that of a sheet seen edge on, gains nothing from finer texels.
    constexpr double longest_texel = 16.0;
    const double least_reach = std::max(std::max(half.x, half.y) / longest_texel, 1e-6);
    const double reach_x = std::max(half.x, least_reach), reach_y = std::max(half.y, least_reach);
    const double depth_reach = std::max(half.z * 1.0005, 1e-6);

    const Vec3d middle = basis.right * centre.x + basis.up * centre.y + basis.forward * centre.z;
    return parallel_view({basis, middle}, (resolution - 2) / (2.0 * reach_x),
                         (resolution - 2) / (2.0 * reach_y), depth_reach, resolution);
}

double margin_factor(int resolution, int margin_texels) {
    CHECK(resolution > 2 * margin_texels);
    return static_cast<double>(resolution) / (resolution - 2 * margin_texels);
}

LightView perspective_light_view(Vec3d position, Vec3d direction, double angle_deg, double near_m,
                                 double far_m, int resolution) {
    const double half = 0.5 * angle_deg * radians;
    return tangent_light_view(position, direction, num::sin(half) / num::cos(half), near_m, far_m,
                              resolution);
}

LightView tangent_light_view(Vec3d position, Vec3d direction, double tangent, double near_m, double far_m,
                             int resolution) {
    const Frame frame{look_basis(direction, {0, 1, 0}), position};
    const double texels_per_tangent = 0.5 * resolution / tangent;
    LightView view = perspective_view(frame, texels_per_tangent, resolution, resolution);
    // Z w = (w - near) * far / (far - near).
    const double k = far_m / (far_m - near_m);
    Vec4d z = frame.row(frame.basis.forward, k);
    z.w -= near_m * k;
    set_row(view.to_map, 2, z);
    view.near_w = near_m;
    return view;
}

std::vector<LightView> cube_light_views(Vec3d position, double near_m, double far_m, int resolution,
                                        int margin_texels) {
    const double tangent = margin_factor(resolution, margin_texels);
    std::vector<LightView> views;
    for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1},
                             Vec3d{0, 0, -1}}) {
        views.push_back(tangent_light_view(position, axis, tangent, near_m, far_m, resolution));
    }
    return views;
}

int cube_face(Vec3f d) {
    const float ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
    if (ax >= ay && ax >= az) return d.x >= 0 ? 0 : 1;
    if (ay >= az) return d.y >= 0 ? 2 : 3;
    return d.z >= 0 ? 4 : 5;
}

View camera_view(const Camera& camera, int width, int height) {
    const Frame frame{look_basis(camera.look_at - camera.eye, camera.up), camera.eye};
    if (camera.kind == CameraKind::perspective) {
        const double half = 0.5 * camera.vfov_deg * radians;
        View view = perspective_view(frame, 0.5 * height * num::cos(half) / num::sin(half), width, height);
        set_row(view.to_map, 2, {0, 0, 0, -camera.near_m});
        view.near_w = camera.near_m;
        view.min_depth = -1.0f;
        view.max_depth = 0.0f;
        return view;
    }
    View view;
    view.width = width;
    view.height = height;
    const double texels_per_m = height / camera.height_m;
    Vec4d x = frame.row(frame.basis.right, texels_per_m), y = frame.row(frame.basis.up, -texels_per_m);
    x.w += 0.5 * width;
    y.w += 0.5 * height;
    set_row(view.to_map, 0, x);
    set_row(view.to_map, 1, y);
    // Everything beyond the near plane, which is Z = 0: depth in units of a range that holds any scene.
    Vec4d z = frame.row(frame.basis.forward, 1.0 / orthographic_camera_range_m);
    z.w -= camera.near_m / orthographic_camera_range_m;
    set_row(view.to_map, 2, z);
    return view;
}

Vec3d to_map_space(const View& view, Vec3d world) {
    const Vec4d h = view.to_map * Vec4d{world.x, world.y, world.z, 1.0};
    const double inv = 1.0 / h.w;
    return {h.x * inv, h.y * inv, h.z * inv};
}

}  // namespace obscura
