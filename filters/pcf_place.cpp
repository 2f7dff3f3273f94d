#include "filters/pcf_place.h"

#include <algorithm>
#include <bit>

#include "core/vec_arrays.h"
#include "raster/view.h"

namespace obscura::ref {
namespace {

/// Which way the light is, not normalised.
Vec3f towards(const PcfLight& light, Vec3f p) {
    if (light.directional) return {light.to_light[0], light.to_light[1], light.to_light[2]};
    return Vec3f{light.position[0], light.position[1], light.position[2]} - p;
}

/// A receiver on its way to the map, relative to the eye; `n` turned to the light's side.
struct Moved {
    double x, y, z;
    float reach;  ///< |x| + |y| + |z|
    Vec3f n, to_light;
    double row(const double (&m)[4]) const { return (m[0] * x + m[1] * y) + (m[2] * z + m[3]); }
};

/// Distance of p from the light along the axis of the map that sees it; 1 for parallel light.
double axial_distance(const PcfLight& light, const Moved& p) {
    if (light.views == 1) return light.view[0].perspective ? p.row(light.view[0].to_map[3]) : 1.0;
    const Vec3f l = p.to_light;
    return static_cast<double>(lane_max(lane_max(std::fabs(l.x), std::fabs(l.y)), std::fabs(l.z)));
}

Moved move(const PcfLight& light, Vec3f p, Vec3f n, Vec3f to_light, bool open) {
    Moved m{static_cast<double>(p.x),
            static_cast<double>(p.y),
            static_cast<double>(p.z),
            (std::fabs(p.x) + std::fabs(p.y)) + std::fabs(p.z),
            n,
            to_light};
    if (!open || light.view[0].offset_m == 0) return m;
    double offset = light.view[0].offset_m * axial_distance(light, m);
    if (!light.directional) {
        offset = lane_min(offset, static_cast<double>(pcf_nearest_offset * dot(n, to_light)));
    }
    m.x = m.x + static_cast<double>(n.x) * offset;
    m.y = m.y + static_cast<double>(n.y) * offset;
    m.z = m.z + static_cast<double>(n.z) * offset;
    m.to_light = towards(light, {static_cast<float>(m.x), static_cast<float>(m.y), static_cast<float>(m.z)});
    return m;
}

void place(const PcfView& view, const Moved& p, PcfPlace& r) {
    const double w = p.row(view.to_map[3]);
    const double inv = view.perspective ? 1.0 / w : 1.0;
    r.kind = view.perspective && !(w >= view.near_w) ? PcfPlace::before_near : PcfPlace::on_map;
    // Far off the map any place will do, as long as its number fits an integer.
    const double low = -8.0, high = static_cast<double>(view.size) + 8.0;
    r.X = lane_min(lane_max(p.row(view.to_map[0]) * inv, low), high);
    r.Y = lane_min(lane_max(p.row(view.to_map[1]) * inv, low), high);
    const float least = pcf_least_cosine * std::sqrt(dot(p.to_light, p.to_light));
    const float inv_nl = 1.0f / lane_max(dot(p.n, p.to_light), least);
    r.slope_x = dot(p.n, Vec3f{view.slope_x[0], view.slope_x[1], view.slope_x[2]}) * inv_nl;
    r.slope_y = dot(p.n, Vec3f{view.slope_y[0], view.slope_y[1], view.slope_y[2]}) * inv_nl;
    const float off_plane = pcf_position_error * p.reach * (view.step * static_cast<float>(inv)) * inv_nl;
    const float snap = pcf_snap * (std::fabs(r.slope_x) + std::fabs(r.slope_y));
    r.depth = static_cast<float>(p.row(view.to_map[2]) * inv) - ((off_plane + snap) + pcf_depth_error);
}

/// Square of the way on the map that a step on the receiver's plane makes.
double squared_way(const PcfView& view, const Moved& p, const PcfPlace& r, Vec3f step) {
    const auto along = [&](const double(&m)[4]) {
        return (m[0] * static_cast<double>(step.x) + m[1] * static_cast<double>(step.y)) +
               m[2] * static_cast<double>(step.z);
    };
    double dx = along(view.to_map[0]), dy = along(view.to_map[1]);
    if (view.perspective) {
        const double w = p.row(view.to_map[3]), dw = along(view.to_map[3]);
        dx = (dx - r.X * dw) / w;
        dy = (dy - r.Y * dw) / w;
    }
    return dx * dx + dy * dy;
}

/// Texels that the pixel spans on the plane through p with normal g, which is turned to the viewer: the ray's
/// step to the neighbour pixel, continued along the ray to the plane (Igehy 1999, section 3.1).
float footprint_of(const CameraRays& rays, const PcfView& view, Vec3f p, Vec3f g, float depth,
                   const Moved& moved, const PcfPlace& r) {
    const float z = view_distance(rays, depth);
    const Vec3f way = rays.perspective ? p : to_float(vec(rays.dir0));
    // Planes seen edge-on are taken as if they were not quite.
    const float facing = lane_min(dot(g, way), -(pcf_least_cosine * std::sqrt(dot(way, way))));
    const auto step = [&](const double(&dir)[3], const double(&origin)[3]) {
        const Vec3f a = rays.perspective ? to_float(vec(dir)) * z : to_float(vec(origin));
        return a - way * (dot(g, a) / facing);
    };
    const double right = squared_way(view, moved, r, step(rays.dir_x, rays.origin_x));
    const double down = squared_way(view, moved, r, step(rays.dir_y, rays.origin_y));
    return std::sqrt(static_cast<float>(lane_max(right, down)));
}

}  // namespace

PcfPlace pcf_place(const SurfaceBlock& s, const PcfLight& light, int at) {
    PcfPlace r;
    const int group = at / 16;
    const std::uint32_t bit = 1u << (at & 15);
    if ((s.covered[group] & bit) == 0) return r;

    // A face that looks away from the light is dark: no lookup.
    const Vec3f p = {s.px[at], s.py[at], s.pz[at]}, g = {s.gx[at], s.gy[at], s.gz[at]};
    const Vec3f l = towards(light, p);
    const float cosine = dot(g, l);
    r.kind = PcfPlace::turned_away;
    if (!(0.0f < cosine) && (s.thin[group] & bit) == 0) return r;

    const Moved moved = move(light, p, cosine < 0.0f ? -g : g, l, (s.open[group] & bit) != 0);
    r.view = light.views == 6 ? cube_face(-moved.to_light) : 0;
    const PcfView& view = light.view[r.view];
    place(view, moved, r);
    if (light.filter == PcfFilter::hierarchical) {
        const float footprint = footprint_of(light.camera, view, p, g, s.depth[at], moved, r);
        const auto squares = static_cast<float>(light.side == 1 ? 1 : light.side - 1);
        r.tap_texels = lane_min(lane_max(footprint / squares, 1.0f), static_cast<float>(view.size));
    }
    return r;
}

Levels levels_of(const PcfPlace& r) {
    // Exponent and mantissa.
    const auto bits = std::bit_cast<std::uint32_t>(r.tap_texels);
    return {static_cast<int>(bits >> 23) - 127, static_cast<float>(bits & 0x7fffffu) * 0x1p-23f};
}

}  // namespace obscura::ref
