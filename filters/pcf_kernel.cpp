// Percentage-closer filtering, sixteen receivers of a row at a time. See pcf_ref.cpp for the meaning of each
// step.

#include "core/simd_vec.h"
#include "filters/pcf.h"

namespace obscura::OBSCURA_ISA {
namespace {

struct Receivers16 {
    Mask before_near;
    F64 X, Y;
    F32 depth, slope_x, slope_y;
};

struct Moved16 {
    F64 x, y, z;
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
    Moved16 m{to_f64(p.x), to_f64(p.y), to_f64(p.z), n, to_light};
    if (open == 0) return m;
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
    r.before_near = mask_of(0);
    if (view.perspective) {
        const F64 w = p.row(view.to_map[3]);
        const F64 inv = splat(1.0) / w;
        X = X * inv;
        Y = Y * inv;
        Z = Z * inv;
        r.before_near = ~greater_equal(w, splat(view.near_w));
    }
    const F64 low = splat(-8.0), high = splat(static_cast<double>(view.size) + 8.0);
    r.X = min(max(X, low), high);
    r.Y = min(max(Y, low), high);
    r.depth = min(to_f32(Z), splat(1.0f));
    const F32 least = splat(pcf_least_cosine) * sqrt(dot(p.to_light, p.to_light));
    const F32 inv_nl = splat(1.0f) / max(dot(p.n, p.to_light), least);
    r.slope_x = dot(p.n, splat3(view.slope_x)) * inv_nl;
    r.slope_y = dot(p.n, splat3(view.slope_y)) * inv_nl;
    return r;
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

/// Mean over the kernel.
template <int side, bool inside_map>
OBSCURA_INLINE F32 filtered(const PcfView& view, bool clamp, const Receivers16& r, const I32& ix,
                            const I32& iy, const F32& fx, const F32& fy) {
    constexpr std::int32_t reach = side / 2;
    [[maybe_unused]] const std::int32_t last = view.size - 1;
    // Place of a texel in its blocks of 4 x 4: a part for its column, a part for its row.
    I32 column[side], row_start[side];
    Mask column_inside[side], row_inside[side];
    for (std::int32_t k = 0; k < side; ++k) {
        I32 x = ix + splat(k - reach), y = iy + splat(k - reach);
        if constexpr (!inside_map) {
            column_inside[k] = between(x, 0, last);
            row_inside[k] = between(y, 0, last);
            x = clamped(x, 0, last);
            y = clamped(y, 0, last);
        }
        column[k] = shift_left<4>(shift_right<2>(x)) + (x & splat(std::int32_t{3}));
        row_start[k] = shift_right<2>(y) * splat(view.size * 4) + shift_left<2>(y & splat(std::int32_t{3}));
    }
    // The receiver's plane at the texels' centres.
    const F32 to_centre_x = to_f32((to_f64(ix) + splat(0.5)) - r.X);
    const F32 to_centre_y = to_f32((to_f64(iy) + splat(0.5)) - r.Y);
    F32 rise_x[side];
    for (std::int32_t k = 0; k < side; ++k)
        rise_x[k] = r.slope_x * (to_centre_x + splat(static_cast<float>(k - reach)));
    F32 sum = splat(0.0f);
    for (std::int32_t j = 0; j < side; ++j) {
        const F32 rise_y = r.slope_y * (to_centre_y + splat(static_cast<float>(j - reach)));
        F32 row = splat(0.0f);
        for (std::int32_t i = 0; i < side; ++i) {
            const F32 depth = r.depth + min(rise_x[i] + rise_y, splat(0.0f));
            Mask lit = less_equal(depth, gather(view.stored, column[i] + row_start[j]));
            if constexpr (!inside_map) {
                if (!clamp) lit = lit | ~(column_inside[i] & row_inside[j]);
            }
            row = row + select(lit, tap_weight(i, side, fx), splat(0.0f));
        }
        sum = sum + row * tap_weight(j, side, fy);
    }
    return sum * splat(side == 1 ? 1.0f : (side == 3 ? 0.25f : 0.0625f));
}

template <int side>
OBSCURA_INLINE F32 filtered_side(const PcfView& view, bool clamp, const Receivers16& r, const Mask& active) {
    const I32 x256 = round_to_i32(r.X * splat(256.0)), y256 = round_to_i32(r.Y * splat(256.0));
    I32 ix = shift_right<8>(x256), iy = shift_right<8>(y256);
    const F32 fx = to_f32(x256 & splat(std::int32_t{255})) * splat(1.0f / 256.0f);
    const F32 fy = to_f32(y256 & splat(std::int32_t{255})) * splat(1.0f / 256.0f);
    const std::int32_t low = side / 2, high = view.size - 1 - side / 2;
    const Mask interior = between(ix, low, high) & between(iy, low, high);
    if (high >= low && all(interior | ~active)) {
        // Lanes that nobody asked about must not read beyond the map.
        ix = clamped(ix, low, high);
        iy = clamped(iy, low, high);
        return filtered<side, true>(view, clamp, r, ix, iy, fx, fy);
    }
    return filtered<side, false>(view, clamp, r, ix, iy, fx, fy);
}

F32 lookup(const PcfLight& light, const PcfView& view, const Moved16& p, const Mask& active) {
    const Receivers16 r = place(view, p);
    const bool clamp = !light.directional;
    F32 seen;
    if (light.side == 1) {
        seen = filtered_side<1>(view, clamp, r, active);
    } else if (light.side == 3) {
        seen = filtered_side<3>(view, clamp, r, active);
    } else {
        seen = filtered_side<5>(view, clamp, r, active);
    }
    return select(r.before_near, splat(1.0f), seen);
}

/// Twin of cube_face() (raster/view.h).
OBSCURA_INLINE I32 cube_faces(const Vec3x16& d) {
    const F32 ax = abs(d.x), ay = abs(d.y), az = abs(d.z), zero = splat(0.0f);
    const auto face = [&](const F32& along, std::int32_t positive) {
        return select(less_equal(zero, along), splat(positive), splat(positive + 1));
    };
    const I32 y_or_z = select(less_equal(az, ay), face(d.y, 2), face(d.z, 4));
    return select(less_equal(ay, ax) & less_equal(az, ax), face(d.x, 0), y_or_z);
}

F32 group_visibility(const SurfaceBlock& s, const PcfLight& light, int at) {
    const std::uint32_t covered = s.covered[at / 16];
    F32 visibility = splat(0.0f);
    if (covered == 0) return visibility;
    const Vec3x16 p = load3(s.px + at, s.py + at, s.pz + at), g = load3(s.gx + at, s.gy + at, s.gz + at);
    const Vec3x16 l = towards(light, p);
    const F32 cosine = dot(g, l);
    const Mask active = mask_of(covered) & (less(splat(0.0f), cosine) | mask_of(s.thin[at / 16]));
    if (none(active)) return visibility;

    const Moved16 receiver = move(light, p, negated(less(cosine, splat(0.0f)), g), l, s.open[at / 16]);
    if (light.views == 1) {
        return select(active, lookup(light, light.view[0], receiver, active), visibility);
    }
    const I32 face = cube_faces(negated(mask_of(0xffffu), receiver.to_light));
    for (std::int32_t f = 0; f < 6; ++f) {
        const Mask m = active & equal(face, splat(f));
        if (none(m)) continue;
        visibility = select(m, lookup(light, light.view[f], receiver, m), visibility);
    }
    return visibility;
}

}  // namespace

void pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept {
    for (int at = 0; at < block_samples; at += lanes)
        store(visibility + at, group_visibility(surface, light, at));
}

}  // namespace obscura::OBSCURA_ISA
