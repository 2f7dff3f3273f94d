#pragma once
// Sixteen receivers and their descents through the octree of a stack. Kernel files only; what each step means
// stands in stack_query_ref.cpp, which computes in the same order.

#include "core/simd.h"
#include "hierarchy/stack/stack_query.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// What is the same in all maps.
struct Receivers16 {
    F32 a, b, h, na, nb, nh, steep_a, steep_b, off;
    F32 top, per_m;
    Mask before_near, valid;
};

/// A run of maps, the same for all lanes or each lane its own.
struct Range16 {
    F32 sigma_x[2], sigma_y[2], tau[2];
};

/// Where receivers are seen in a run of maps.
struct Seen16 {
    F32 x[2], y[2];
    I32 ix[2], iy[2];
    Mask inside, outside, facing, away;
    F32 nearest, deepest;
};

OBSCURA_INLINE F32 along(const double (&m)[4], const F64& x, const F64& y, const F64& z) {
    return to_f32((splat(m[0]) * x + splat(m[1]) * y) + (splat(m[2]) * z + splat(m[3])));
}

OBSCURA_INLINE F32 part_of(const float (&m)[3], const F32& x, const F32& y, const F32& z) {
    return (splat(m[0]) * x + splat(m[1]) * y) + splat(m[2]) * z;
}

/// sixteen floats from `first` on; zeros beyond the last.
OBSCURA_INLINE F32 load_some(const float* p, std::size_t first, std::size_t count) {
    if (count - first >= 16) return load(p + first);
    alignas(64) float some[16] = {};
    for (std::size_t k = 0; k < count - first; ++k)
        some[k] = p[first + k];
    return load(some);
}

OBSCURA_INLINE Receivers16 receivers_at(const StackLookup& s, const StackPoints& p, std::size_t first) {
    Receivers16 r;
    const std::size_t rest = p.count - first;
    r.valid = mask_of(rest >= 16 ? 0xffffu : (1u << rest) - 1u);
    const F32 px = load_some(p.px, first, p.count), py = load_some(p.py, first, p.count),
              pz = load_some(p.pz, first, p.count);
    const F32 nx = load_some(p.nx, first, p.count), ny = load_some(p.ny, first, p.count),
              nz = load_some(p.nz, first, p.count);
    const F64 x = to_f64(px), y = to_f64(py), z = to_f64(pz);
    r.a = along(s.frame.a, x, y, z);
    r.b = along(s.frame.b, x, y, z);
    r.h = along(s.frame.h, x, y, z);
    r.na = part_of(s.normal_a, nx, ny, nz);
    r.nb = part_of(s.normal_b, nx, ny, nz);
    r.nh = part_of(s.normal_h, nx, ny, nz);
    r.top = splat(static_cast<float>(s.frame.depth_top));
    r.per_m = splat(static_cast<float>(s.frame.depth_per_m));
    r.steep_a = r.per_m * r.na;
    r.steep_b = r.per_m * r.nb;
    r.off = (splat(stack_position_error) * ((abs(px) + abs(py)) + abs(pz))) * r.per_m;
    r.before_near = less_equal(splat(static_cast<float>(s.frame.near_h)), r.h);
    return r;
}

OBSCURA_INLINE F32 on_or_beside(const F32& x, std::int32_t size) {
    return min(max(x, splat(-8.0f)), splat(static_cast<float>(size) + 8.0f));
}

OBSCURA_INLINE I32 floor_of(const F32& x) {
    const I32 cut = to_i32(x);
    return select(less(x, to_f32(cut)), cut - splat(std::int32_t{1}), cut);
}

OBSCURA_INLINE Range16 range_of(const SliceRange& r) {
    return {{splat(r.sigma_x[0]), splat(r.sigma_x[1])},
            {splat(r.sigma_y[0]), splat(r.sigma_y[1])},
            {splat(r.tau[0]), splat(r.tau[1])}};
}

OBSCURA_INLINE void see_axis(const F32& at, const F32& h, const F32 (&sigma)[2], const F32 (&r)[2],
                             std::int32_t size, F32 (&to)[2], I32 (&texel)[2]) {
    const F32 m0 = sigma[0] * h, m1 = sigma[1] * h;
    const F32 low = at + min(m0, m1), high = at + max(m0, m1);
    to[0] = on_or_beside(min(low * r[0], low * r[1]), size);
    to[1] = on_or_beside(max(high * r[0], high * r[1]), size);
    texel[0] = floor_of(to[0]);
    texel[1] = floor_of(to[1]);
}

OBSCURA_INLINE Mask within(const I32 (&i)[2], std::int32_t size) {
    return ~less(i[0], splat(std::int32_t{0})) & less(i[1], splat(size));
}
OBSCURA_INLINE Mask beyond(const I32 (&i)[2], std::int32_t size) {
    return less(i[1], splat(std::int32_t{0})) | ~less(i[0], splat(size));
}

OBSCURA_INLINE Seen16 see(const Receivers16& p, const Range16& range, std::int32_t size) {
    Seen16 s;
    const F32 one = splat(1.0f), zero = splat(0.0f), half = splat(0.5f), least = splat(stack_least_cosine);
    const F32 r0 = one / (one - range.tau[0] * p.h), r1 = one / (one - range.tau[1] * p.h);
    const F32 r[2] = {min(r0, r1), max(r0, r1)};
    see_axis(p.a, p.h, range.sigma_x, r, size, s.x, s.ix);
    see_axis(p.b, p.h, range.sigma_y, r, size, s.y, s.iy);
    s.inside = within(s.ix, size) & within(s.iy, size);
    s.outside = beyond(s.ix, size) | beyond(s.iy, size);

    const F32 x0 = p.na * (range.sigma_x[0] + range.tau[0] * s.x[0]),
              x1 = p.na * (range.sigma_x[1] + range.tau[1] * s.x[1]);
    const F32 y0 = p.nb * (range.sigma_y[0] + range.tau[0] * s.y[0]),
              y1 = p.nb * (range.sigma_y[1] + range.tau[1] * s.y[1]);
    const F32 d[2] = {(p.nh - max(x0, x1)) - max(y0, y1), (p.nh - min(x0, x1)) - min(y0, y1)};
    s.away = less_equal(d[1], zero);
    s.facing = less(zero, d[0]);
    const F32 inv[2] = {one / max(d[1], least), one / max(d[0], least)};

    const F32 g0 = p.h * r[0], g1 = p.h * r[1];
    const F32 near_z = p.top - p.per_m * max(g0, g1), far_z = p.top - p.per_m * min(g0, g1);
    F32 slope_x[2], slope_y[2], error[2];
    for (int k = 0; k < 2; ++k) {
        slope_x[k] = (abs(p.steep_a) * r[k]) * inv[k];
        slope_y[k] = (abs(p.steep_b) * r[k]) * inv[k];
        error[k] = (((p.off * (r[k] * r[k])) * inv[k]) + splat(stack_snap) * (slope_x[k] + slope_y[k])) +
                   splat(stack_depth_error);
    }
    s.nearest = min((near_z - error[1]) - (slope_x[1] * half + slope_y[1] * half), one);
    s.deepest = min(far_z - error[0], one);
    return s;
}

/// Of one map.
OBSCURA_INLINE F32 compared_depth(const Receivers16& p, const Range16& map, const Seen16& s) {
    const F32 one = splat(1.0f), half = splat(0.5f);
    const F32 r = one / (one - map.tau[0] * p.h);
    const F32 d = (p.nh - p.na * (map.sigma_x[0] + map.tau[0] * s.x[0])) -
                  p.nb * (map.sigma_y[0] + map.tau[0] * s.y[0]);
    const F32 inv = one / max(d, splat(stack_least_cosine));
    const F32 z = p.top - p.per_m * (p.h * r);
    const F32 slope_x = (p.steep_a * r) * inv, slope_y = (p.steep_b * r) * inv;
    const F32 error = (((p.off * (r * r)) * inv) + splat(stack_snap) * (abs(slope_x) + abs(slope_y))) +
                      splat(stack_depth_error);
    const F32 to_middle_x = (to_f32(s.ix[0]) + half) - s.x[0],
              to_middle_y = (to_f32(s.iy[0]) + half) - s.y[0];
    return min((z - error) + min(slope_x * to_middle_x + slope_y * to_middle_y, splat(0.0f)), one);
}

// --- descents ------------------------------------------------------------------------------------------

/// Unit indices have 32 bits, but gathers take signed ones: lanes carry index - 2^31 (see
/// hierarchy/descents.h).
constexpr std::uint32_t index_bias = 0x80000000u;

OBSCURA_INLINE const std::uint8_t* biased_words(const StackCode& code) {
    return reinterpret_cast<const std::uint8_t*>(reinterpret_cast<std::uintptr_t>(code.words) +
                                                 std::uintptr_t{index_bias} * 4);
}

/// Where sixteen descents stand, each at a height of its own.
struct Places16 {
    I32 node, value;  ///< biased words
    I32 height;
    Mask ended;
};

template <bool wide>
OBSCURA_INLINE Places16 at_root(const StackCode& code) {
    const auto root = static_cast<std::int32_t>(index_bias);
    const std::int32_t levels = code.shape.levels();
    return {splat(root), splat(root + (wide ? 2 : 1)), splat(levels), mask_of(levels == 0 ? 0xffffu : 0u)};
}

/// Kinds of the children on the first and on the second half of an axis, for lanes whose [low, high] meets
/// them.
OBSCURA_INLINE I32 kinds_met(const I32& low, const I32& high, std::int32_t first, std::int32_t second) {
    const I32 one = splat(std::int32_t{1}), none = splat(std::int32_t{0});
    return select(any_bit(low, one), none, splat(first)) | select(any_bit(high, one), splat(second), none);
}

/// Words of the siblings before a child, from the 14 bits of their kinds.
template <bool wide>
OBSCURA_INLINE I32 words_of(const I32& below) {
    alignas(16) static constexpr std::uint8_t narrow_words[16] = {0, 1, 1, 2, 1, 2, 2, 3,
                                                                  1, 2, 2, 3, 2, 3, 3, 4};
    alignas(16) static constexpr std::uint8_t wide_words[16] = {0, 1, 2, 3, 1, 2, 3, 4,
                                                                2, 3, 4, 5, 3, 4, 5, 6};
    const auto& table = wide ? wide_words : narrow_words;
    const I32 nibble = splat(std::int32_t{15});
    return (small_table(table, below & nibble) + small_table(table, shift_right_logical<4>(below) & nibble)) +
           (small_table(table, shift_right_logical<8>(below) & nibble) +
            small_table(table, shift_right_logical<12>(below) & nibble));
}

/// From nodes of this height, those lanes of `here`: one step down, or to an end, for those whose box and
/// maps lie in one child, or meet none. Returns the lanes that are stuck.
template <bool wide>
OBSCURA_INLINE Mask step_down(const StackCode& code, const std::uint8_t* base, int height, const Mask& here,
                              const Seen16& s, const I32 (&k)[2], Places16& at) {
    const I32 header = gather_bytes<4>(base, at.node);
    const int map_bit = height - 1 - code.shape.map_start(),
              slice_bit = height - 1 - code.shape.slice_start();
    const I32 none = splat(std::int32_t{0}), one = splat(std::int32_t{1});
    // Bits that tell the halves apart; an axis without is all in its first half.
    I32 x[2] = {none, none}, y[2] = {none, none}, z[2] = {none, none};
    for (int e = 0; e < 2 && map_bit >= 0; ++e) {
        x[e] = shift_right(s.ix[e], map_bit) & one;
        y[e] = shift_right(s.iy[e], map_bit) & one;
    }
    for (int e = 0; e < 2 && slice_bit >= 0; ++e)
        z[e] = shift_right(k[e], slice_bit) & one;
    const I32 met = (kinds_met(x[0], x[1], 0x3333, 0xcccc) & kinds_met(y[0], y[1], 0x0f0f, 0xf0f0)) &
                    kinds_met(z[0], z[1], 0x00ff, 0xff00);
    const Mask nothing = here & ~any_bit(header, met);
    const Mask parted = any_bit((x[0] ^ x[1]) | (y[0] ^ y[1]) | (z[0] ^ z[1]), one);
    const Mask down = here & ~nothing & ~parted;

    const I32 bit = shift_left<1>(x[0]) | shift_left<2>(y[0]) | shift_left<3>(z[0]);
    const I32 kind = shift_right_logical(header, bit);
    const I32 below =
        header & shift_right_logical(splat(std::int32_t{0x3fff}), splat(std::int32_t{14}) - bit);
    I32 offset = shift_right_logical<16>(header);
    if constexpr (wide) offset = offset | shift_left<16>(gather_bytes<4>(base + 4, at.node));
    const std::uint32_t scale = code.offset_scale[height];
    if (scale != 1) offset = offset * splat(static_cast<std::int32_t>(scale));
    const I32 child = at.node + offset + words_of<wide>(below);
    const Mask has_value = down & any_bit(kind, one), inner = down & any_bit(kind, splat(std::int32_t{2}));
    at.value = select(has_value, child + select(inner, splat(std::int32_t{wide ? 2 : 1}), none), at.value);
    at.node = select(inner, child, at.node);
    at.height = select(down, splat(height - 1), at.height);
    at.ended = at.ended | nothing | (down & ~inner);
    return here & ~nothing & ~down;
}

/// As far as each lane of `going` comes. Returns the headers read.
template <bool wide>
OBSCURA_INLINE std::uint64_t descend(const StackCode& code, const std::uint8_t* base, Mask going,
                                     const Seen16& s, const I32 (&k)[2], Places16& at) {
    std::uint64_t headers = 0;
    going = going & ~at.ended;
    int height = highest(select(going, at.height, splat(std::int32_t{0})));
    for (; height > 0 && any(going); --height) {
        const Mask here = going & equal(at.height, splat(height));
        if (none(here)) continue;
        headers += static_cast<std::uint64_t>(__builtin_popcount(bits(here)));
        const Mask stuck = step_down<wide>(code, base, height, here, s, k, at);
        going = going & ~stuck & ~at.ended;
    }
    return headers;
}

OBSCURA_INLINE F32 values(const std::uint8_t* base, const Places16& at) {
    return bitcast_f32(gather_bytes<4>(base, at.value));
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
