#pragma once
// What sixteen samples of a row ask of a light's map. Kernel files only; the meaning of each step is in
// filters/pcf_place.cpp.

#include "core/simd_vec.h"
#include "filters/pcf.h"
#include "raster/cube_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

struct Receivers16 {
    Mask before_near;
    F64 X, Y;
    F32 depth, slope_x, slope_y;
    F32 tap_texels;  ///< hierarchical
};

struct Moved16 {
    F64 x, y, z;
    F32 reach;
    Vec3x16 n, to_light;
    OBSCURA_INLINE F64 row(const double (&m)[4]) const {
        return (splat(m[0]) * x + splat(m[1]) * y) + (splat(m[2]) * z + splat(m[3]));
    }
};

OBSCURA_INLINE Vec3x16 towards(const PcfLight& light, const Vec3x16& p) {
    return light.directional ? splat3(light.to_light) : splat3(light.position) - p;
}

OBSCURA_INLINE F64 axial_distance(const PcfLight& light, const Moved16& p) {
    if (light.views == 1) return light.view[0].perspective ? p.row(light.view[0].to_map[3]) : splat(1.0);
    const Vec3x16& l = p.to_light;
    return to_f64(max(max(abs(l.x), abs(l.y)), abs(l.z)));
}

/// Moves the lanes of `open`.
OBSCURA_INLINE Moved16 move(const PcfLight& light, const Vec3x16& p, const Vec3x16& n,
                            const Vec3x16& to_light, std::uint32_t open) {
    Moved16 m{to_f64(p.x), to_f64(p.y), to_f64(p.z), (abs(p.x) + abs(p.y)) + abs(p.z), n, to_light};
    if (open == 0 || light.view[0].offset_m == 0) return m;
    F64 offset = splat(light.view[0].offset_m) * axial_distance(light, m);
    if (!light.directional) offset = min(offset, to_f64(splat(pcf_nearest_offset) * dot(n, to_light)));
    const Vec3x16 way = select(mask_of(open), n, splat3(0.0f, 0.0f, 0.0f));
    m.x = m.x + to_f64(way.x) * offset;
    m.y = m.y + to_f64(way.y) * offset;
    m.z = m.z + to_f64(way.z) * offset;
    m.to_light = towards(light, {to_f32(m.x), to_f32(m.y), to_f32(m.z)});
    return m;
}

OBSCURA_INLINE Receivers16 place(const PcfView& view, const Moved16& p) {
    Receivers16 r;
    F64 X = p.row(view.to_map[0]), Y = p.row(view.to_map[1]), Z = p.row(view.to_map[2]);
    F32 step = splat(view.step);
    r.before_near = mask_of(0);
    if (view.perspective) {
        const F64 w = p.row(view.to_map[3]);
        const F64 inv = splat(1.0) / w;
        X = X * inv;
        Y = Y * inv;
        Z = Z * inv;
        step = step * to_f32(inv);
        r.before_near = ~greater_equal(w, splat(view.near_w));
    }
    const F64 low = splat(-8.0), high = splat(static_cast<double>(view.size) + 8.0);
    r.X = min(max(X, low), high);
    r.Y = min(max(Y, low), high);
    const F32 least = splat(pcf_least_cosine) * sqrt(dot(p.to_light, p.to_light));
    const F32 inv_nl = splat(1.0f) / max(dot(p.n, p.to_light), least);
    r.slope_x = dot(p.n, splat3(view.slope_x)) * inv_nl;
    r.slope_y = dot(p.n, splat3(view.slope_y)) * inv_nl;
    const F32 off_plane = splat(pcf_position_error) * p.reach * step * inv_nl;
    const F32 snap = splat(pcf_snap) * (abs(r.slope_x) + abs(r.slope_y));
    r.depth = to_f32(Z) - ((off_plane + snap) + splat(pcf_depth_error));
    return r;
}

/// Of the receiver's plane at a tap where it has risen by `rise`.
OBSCURA_INLINE F32 tap_depth(const F32& depth, const F32& rise) {
    return min(depth + min(rise, splat(0.0f)), splat(1.0f));
}

OBSCURA_INLINE F32 tap_weight(int k, int side, const F32& f) {
    if (side == 1) return splat(1.0f);
    if (k == 0) return splat(1.0f) - f;
    return k == side - 1 ? f : splat(1.0f);
}

OBSCURA_INLINE Mask between(const I32& a, std::int32_t low, std::int32_t high) {
    return less_equal(splat(low), a) & less_equal(a, splat(high));
}
OBSCURA_INLINE I32 clamped(const I32& a, std::int32_t low, std::int32_t high) {
    return min(max(a, splat(low)), splat(high));
}

/// Square of the way on the map that a step on the receiver's plane makes.
OBSCURA_INLINE F64 squared_way(const PcfView& view, const Moved16& p, const Receivers16& r,
                               const Vec3x16& step) {
    const F64 sx = to_f64(step.x), sy = to_f64(step.y), sz = to_f64(step.z);
    const auto along = [&](const double(&m)[4]) {
        return (splat(m[0]) * sx + splat(m[1]) * sy) + splat(m[2]) * sz;
    };
    F64 dx = along(view.to_map[0]), dy = along(view.to_map[1]);
    if (view.perspective) {
        const F64 w = p.row(view.to_map[3]), dw = along(view.to_map[3]);
        dx = (dx - r.X * dw) / w;
        dy = (dy - r.Y * dw) / w;
    }
    return dx * dx + dy * dy;
}

OBSCURA_INLINE Vec3x16 splat_vec(const double (&v)[3]) {
    return splat3(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
}

OBSCURA_INLINE F32 footprint_of(const CameraRays& rays, const PcfView& view, const Vec3x16& p,
                                const Vec3x16& g, const F32& depth, const Moved16& moved,
                                const Receivers16& r) {
    const F32 z =
        rays.perspective ? splat(rays.z_scale) / depth : splat(rays.z_scale) * depth + splat(rays.z_near);
    const Vec3x16 way = rays.perspective ? p : splat_vec(rays.dir0);
    const F32 facing = min(dot(g, way), splat(-0.0f) ^ (splat(pcf_least_cosine) * sqrt(dot(way, way))));
    const auto step = [&](const double(&dir)[3], const double(&origin)[3]) {
        const Vec3x16 a = rays.perspective ? splat_vec(dir) * z : splat_vec(origin);
        return a - way * (dot(g, a) / facing);
    };
    const F64 right = squared_way(view, moved, r, step(rays.dir_x, rays.origin_x));
    const F64 down = squared_way(view, moved, r, step(rays.dir_y, rays.origin_y));
    return sqrt(to_f32(max(right, down)));
}

/// The two levels around tap_texels; blend 0: the finer alone.
struct Levels16 {
    I32 fine;
    F32 blend;
};
OBSCURA_INLINE Levels16 levels_of(const Receivers16& r) {
    const I32 tap_texels = bitcast_i32(r.tap_texels);
    return {shift_right<23>(tap_texels) - splat(std::int32_t{127}),
            to_f32(tap_texels & splat(std::int32_t{0x7fffff})) * splat(0x1p-23f)};
}

/// Calls visit(view, receivers, active) for each view that the active lanes among samples at .. at + 15 ask.
/// Lanes that face away from the light ask none.
template <class Visit>
OBSCURA_INLINE void visit_receivers(const SurfaceBlock& s, const PcfLight& light, int at, Visit&& visit) {
    const std::uint32_t covered = s.covered[at / 16];
    if (covered == 0) return;
    const Vec3x16 p = load3(s.px + at, s.py + at, s.pz + at), g = load3(s.gx + at, s.gy + at, s.gz + at);
    const Vec3x16 l = towards(light, p);
    const F32 cosine = dot(g, l);
    const Mask asking = mask_of(covered) & (less(splat(0.0f), cosine) | mask_of(s.thin[at / 16]));
    if (none(asking)) return;

    const Moved16 moved = move(light, p, negated(less(cosine, splat(0.0f)), g), l, s.open[at / 16]);
    const I32 face =
        light.views == 6 ? cube_faces(negated(mask_of(0xffffu), moved.to_light)) : splat(std::int32_t{0});
    for (std::int32_t f = 0; f < light.views; ++f) {
        const Mask active = asking & equal(face, splat(f));
        if (none(active)) continue;
        const PcfView& view = light.view[f];
        Receivers16 r = place(view, moved);
        if (light.filter == PcfFilter::hierarchical) {
            const F32 footprint = footprint_of(light.camera, view, p, g, load(s.depth + at), moved, r);
            const F32 squares = splat(static_cast<float>(light.side == 1 ? 1 : light.side - 1));
            r.tap_texels = min(max(footprint / squares, splat(1.0f)), splat(static_cast<float>(view.size)));
        }
        visit(f, r, active);
    }
}

/// Visibility of samples at .. at + 15; lookup(view, receivers, active) answers for the active lanes of one
/// view, and may return anything in the others.
template <class Lookup>
OBSCURA_INLINE F32 group_visibility(const SurfaceBlock& s, const PcfLight& light, int at, Lookup&& lookup) {
    F32 visibility = splat(0.0f);
    visit_receivers(s, light, at, [&](std::int32_t view, const Receivers16& r, const Mask& active) {
        const F32 seen = select(r.before_near, splat(1.0f), lookup(view, r, active));
        visibility = select(active, seen, visibility);
    });
    return visibility;
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
