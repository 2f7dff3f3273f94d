// Points of the camera on the grids of a light's views, sixteen at a time. See exact_ref.cpp for the meaning
// of each step.

#include "core/simd_vec.h"
#include "raster/exact/exact.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE I32 cube_faces(const Vec3x16& d) {
    const F32 ax = abs(d.x), ay = abs(d.y), az = abs(d.z), zero = splat(0.0f);
    const auto face = [&](const F32& along, std::int32_t positive) {
        return select(less_equal(zero, along), splat(positive), splat(positive + 1));
    };
    const Mask x_largest = less_equal(ay, ax) & less_equal(az, ax);
    const Mask y_largest = less_equal(az, ay);
    return select(x_largest, face(d.x, 0), select(y_largest, face(d.y, 2), face(d.z, 4)));
}

OBSCURA_INLINE F64 row(const double (&m)[4], const F64& x, const F64& y, const F64& z) {
    return (splat(m[0]) * x + splat(m[1]) * y) + (splat(m[2]) * z + splat(m[3]));
}

/// Sixteen points on the grid of one view.
struct Located {
    I32 x, y;
    F32 z, rounding;
    std::uint32_t looks;
};

OBSCURA_INLINE Located located(const ExactLight& light, const ExactView& view, const F64& x, const F64& y,
                               const F64& z, const Vec3x16& p, const Vec3x16& g) {
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
        return round_to_i32(min(max(steps, splat(-1.0)), splat(view.steps + 1.0)));
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

OBSCURA_INLINE void append(const Located& from, std::uint32_t lanes_of, std::int32_t first_point,
                           std::int32_t view, ExactSamples& to) {
    alignas(64) std::int32_t x[16], y[16];
    alignas(64) float z[16], rounding[16];
    store(x, from.x);
    store(y, from.y);
    store(z, from.z);
    store(rounding, from.rounding);
    std::int32_t n = to.count;
    for (; lanes_of != 0; lanes_of &= lanes_of - 1, ++n) {
        const int k = __builtin_ctz(lanes_of);
        to.x[n] = x[k];
        to.y[n] = y[k];
        to.z[n] = z[k];
        to.rounding[n] = rounding[k];
        to.point[n] = static_cast<std::uint32_t>(first_point + k);
        to.view[n] = static_cast<std::uint8_t>(view);
    }
    to.count = n;
}

}  // namespace

void exact_locate(const ExactPoints& points, const ExactLight& light, ExactSamples& samples,
                  std::uint32_t* lit) noexcept {
    samples.count = 0;
    for (std::int32_t at = 0; at < points.count; at += lanes) {
        const std::uint32_t covered = points.covered[at / 16];
        lit[at / 16] = 0;
        if (covered == 0) continue;
        const F64 x = load(points.px + at), y = load(points.py + at), z = load(points.pz + at);
        const Vec3x16 p = {to_f32(x - splat(light.eye[0])), to_f32(y - splat(light.eye[1])),
                           to_f32(z - splat(light.eye[2]))};
        const Vec3x16 g = load3(points.gx + at, points.gy + at, points.gz + at);
        const Vec3x16 l = light.directional ? splat3(light.to_light) : splat3(light.position) - p;
        const std::uint32_t asking = covered & (bits(less(splat(0.0f), dot(g, l))) | points.thin[at / 16]);
        lit[at / 16] = asking;
        if (asking == 0) continue;
        const I32 face = light.views == 6 ? cube_faces(negated(mask_of(0xffffu), l)) : splat(std::int32_t{0});
        for (std::int32_t v = 0; v < light.views; ++v) {
            const std::uint32_t of_view = asking & bits(equal(face, splat(v)));
            if (of_view == 0 || light.view[v].levels == 0) continue;
            const Located place = located(light, light.view[v], x, y, z, p, g);
            append(place, of_view & place.looks, at, v, samples);
        }
    }
}

}  // namespace obscura::OBSCURA_ISA
