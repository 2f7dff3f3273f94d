#pragma once
// Sixteen points of the camera as a light sees them. Kernel files only; the meaning of each step is in
// exact_ref.cpp.

#include "raster/cube_lanes.h"
#include "raster/exact/exact_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE F64 row(const double (&m)[4], const F64& x, const F64& y, const F64& z) {
    return (splat(m[0]) * x + splat(m[1]) * y) + (splat(m[2]) * z + splat(m[3]));
}

/// Sixteen points on the grid of one view.
struct Located {
    I32 x, y;
    F32 z, rounding;
    std::uint32_t looks;
};

/// `beyond`: how many steps off the grid places are kept.
OBSCURA_INLINE Located located(const ExactLight& light, const ExactView& view, const F64& x, const F64& y,
                               const F64& z, const Vec3x16& p, const Vec3x16& g, double beyond = 1.0) {
    Located to;
    F64 w = splat(1.0);
    to.looks = 0xffffu;
    if (view.perspective) {
        w = row(view.to_map[3], x, y, z);
        to.looks &= bits(greater_equal(w, splat(view.near_w)));
    }
    const F64 inv = splat(1.0) / w;
    const auto on_grid = [&](int k) {
        const F64 steps = (row(view.to_map[k], x, y, z) * inv) * splat(256.0);
        return round_to_i32(min(max(steps, splat(-beyond)), splat(view.steps + beyond)));
    };
    to.x = on_grid(0);
    to.y = on_grid(1);
    const I32 zero = splat(std::int32_t{0}), last = splat(view.steps);
    to.looks &= bits(less_equal(zero, to.x) & less_equal(to.x, last) & less_equal(zero, to.y) &
                     less_equal(to.y, last));
    to.z = to_f32(row(view.to_map[2], x, y, z) * inv);
    const F32 reach = light.viewer[3] != 0 ? abs(dot(g, p)) : (abs(p.x) + abs(p.y)) + abs(p.z);
    to.rounding = splat(exact_depth_error) * reach + splat(static_cast<float>(view.step_m)) * to_f32(w);
    return to;
}

/// Adds the lanes `left` of sixteen points, from point `at` on, to the samples.
OBSCURA_INLINE void add_samples(const Located& place, std::int32_t at, std::uint32_t left, std::int32_t view,
                                ExactSamples& samples) {
    alignas(64) std::int32_t x[16], y[16];
    alignas(64) float z[16], rounding[16];
    store(x, place.x);
    store(y, place.y);
    store(z, place.z);
    store(rounding, place.rounding);
    for (; left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        const std::int32_t n = samples.count++;
        samples.x[n] = x[k];
        samples.y[n] = y[k];
        samples.z[n] = z[k];
        samples.rounding[n] = rounding[k];
        samples.point[n] = static_cast<std::uint32_t>(at + k);
        samples.view[n] = static_cast<std::uint8_t>(view);
    }
}

/// Sixteen points as a bunch of a view, of which `open` lanes ask.
OBSCURA_INLINE void fill_bunch(const ExactPoints& points, const ExactLight& light, const Located& place,
                               std::int32_t at, std::uint32_t open, Bunch& to) {
    store(to.x, place.x);
    store(to.y, place.y);
    store(to.z, place.z);
    alignas(64) float rounding[16];
    store(rounding, place.rounding);
    store(to.px, load(points.px + at));
    store(to.py, load(points.py + at));
    store(to.pz, load(points.pz + at));
    store(to.face, load(reinterpret_cast<const std::int32_t*>(points.face + at)));
    store(to.point, splat(at) + lane_index());
    const int first = __builtin_ctz(open);
    for (std::uint32_t left = ~open & 0xffffu; left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        to.x[k] = to.x[first];
        to.y[k] = to.y[first];
        to.z[k] = to.z[first];
        rounding[k] = rounding[first];
        to.px[k] = to.px[first];
        to.py[k] = to.py[first];
        to.pz[k] = to.pz[first];
        to.face[k] = to.face[first];
    }
    finish_bunch(light, load(rounding), open, to);
}

/// Sixteen points as the light sees them.
struct Receivers {
    F64 x, y, z;
    Vec3x16 p, g;
    I32 view;
    std::uint32_t asking;
};

OBSCURA_INLINE Receivers receivers(const ExactPoints& points, const ExactLight& light, std::int32_t at) {
    Receivers r;
    r.x = load(points.px + at);
    r.y = load(points.py + at);
    r.z = load(points.pz + at);
    r.p = {to_f32(r.x - splat(light.eye[0])), to_f32(r.y - splat(light.eye[1])),
           to_f32(r.z - splat(light.eye[2]))};
    r.g = load3(points.gx + at, points.gy + at, points.gz + at);
    const Vec3x16 l = light.directional ? splat3(light.to_light) : splat3(light.position) - r.p;
    r.asking = points.covered[at / 16] & (bits(less(splat(0.0f), dot(r.g, l))) | points.thin[at / 16]);
    r.view = light.views == 6 ? cube_faces(negated(mask_of(0xffffu), l)) : splat(std::int32_t{0});
    return r;
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
