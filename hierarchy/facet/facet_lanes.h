#pragma once
// A step of sixteen descents through a tree of the code facet. Kernel files only; the meaning is
// FacetCode::child() and depth() in hierarchy/facet/facet_step.h.
//
// Neighbours mostly see one plane and one edge: each different one of sixteen lanes is read once and its
// arithmetic, in double, done for all.

#include "hierarchy/descents.h"
#include "hierarchy/facet/facet_step.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Bits set in the lowest nine.
OBSCURA_INLINE I32 facet_units(const I32& below) {
    alignas(16) static constexpr std::uint8_t set[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
    const I32 nibble = splat(std::int32_t{15});
    return small_table(set, below & nibble) + small_table(set, shift_right<4>(below) & nibble) +
           shift_right<8>(below);
}

/// One level down, from nodes of height `height` (>= 1) to the children that child_bit() names.
OBSCURA_INLINE void descend(FacetCode, const TreeCode& tree, const std::uint8_t* base, int height,
                            const I32& bit, Numbers16<true>& d) {
    const I32 header = gather_bytes<4>(base, d.node);
    const I32 at = bit + shift_right<1>(bit);
    const I32 kind = shift_right_logical(header, at);
    const I32 below = header & shift_right_logical(splat(std::int32_t{0x1ff}), splat(std::int32_t{9}) - at);
    I32 offset = shift_right_logical<facet_kind_bits>(header);
    const std::uint32_t scale = tree.offset_scale[height];
    if (scale != 1) offset = offset * splat(static_cast<std::int32_t>(scale));
    const I32 child = d.node + offset + facet_units(below);

    const Mask line = d.inner & any_bit(kind, splat(std::int32_t{facet_line}));
    const Mask node = d.inner & ~line;
    const Mask has_value = node & any_bit(kind, splat(std::int32_t{1}));
    d.inner = node & any_bit(kind, splat(std::int32_t{2}));
    const I32 value = child + select(d.inner, splat(std::int32_t{1}), splat(std::int32_t{0}));
    d.value = select(has_value, value, d.value);
    d.node = select(d.inner, child, d.node);
    d.count = select(line, child ^ splat(biased(0)), d.count);
    d.inside = select(line, kind & splat(std::int32_t{3}), d.inside);
}

/// 2^-exponent.
OBSCURA_INLINE F32 facet_powers(const I32& exponent) {
    return bitcast_f32(shift_left<23>(splat(std::int32_t{127}) - exponent));
}

/// Calls f(number, lanes) for each different number of the lanes of `open`.
template <class F>
OBSCURA_INLINE void for_each_number(const I32& number, Mask open, F&& f) {
    alignas(64) std::int32_t of_lane[16];
    store(of_lane, number);
    for (std::uint32_t left = bits(open); left != 0;) {
        const std::int32_t n = of_lane[__builtin_ctz(left)];
        const Mask here = mask_of(left) & equal(number, splat(n));
        f(static_cast<std::uint32_t>(n), here);
        left &= ~bits(here);
    }
}

/// Where the values of lanes that ended in lines are; how far beyond their edges' ramps' start texels are.
OBSCURA_INLINE void choose_sides(const TreeCode& tree, const std::uint8_t* base, const Numbers16<true>& d,
                                 const Mask& line, const I32& x, const I32& y, I32& value, F32& beyond) {
    const I32 bias = splat(biased(0)), one = splat(std::int32_t{1});
    const I32 edge = gather_bytes<4>(base, select(line, d.count ^ bias, d.value));
    const F64 X = to_f64(x), Y = to_f64(y);
    Mask high = line;
    for_each_number(edge, line, [&](std::uint32_t i, const Mask& here) {
        const FacetEdge e = FacetCode::edge(tree, i);
        const F64 distance =
            splat(static_cast<double>(e.a)) * X + (splat(static_cast<double>(e.b)) * Y + splat(e.c));
        const Mask above = greater_equal(distance, splat(0.0));
        const F64 start = splat(facet_ramp_start(e));
        const F32 up = to_f32(distance - start), down = to_f32((splat(0.0) - distance) - start);
        beyond = select(here, select(above, up, down), beyond);
        high = select(here, above, high);
    });
    const I32 low_units = shift_right<1>(d.inside) & one;
    const I32 first = (d.count ^ bias) + one;
    const Mask own_high = any_bit(d.inside, one), own_low = any_bit(low_units, one);
    const I32 own = select(high, first + low_units, first);
    const Mask is_own = line & ((high & own_high) | (~high & own_low));
    value = select(is_own, own, value);
}

/// Depths at texels (x, y).
OBSCURA_INLINE F32 values(FacetCode, const TreeCode& tree, const std::uint8_t* base, const Numbers16<true>& d,
                          const I32& x, const I32& y) {
    const I32 zero = splat(std::int32_t{0});
    const Mask line = ~equal(d.count, zero);
    I32 at = d.value;
    F32 beyond = splat(static_cast<float>(facet_far));
    if (any(line)) choose_sides(tree, base, d, line, x, y, at, beyond);
    const I32 value = gather_bytes<4>(base, at);
    const Mask planes = ~not_negative(value);
    F32 depth = bitcast_f32(value);
    if (none(planes)) return depth;

    const F64 X = to_f64(x) + splat(0.5), Y = to_f64(y) + splat(0.5);
    for_each_number(value & splat(static_cast<std::int32_t>(facet_most_planes - 1)), planes,
                    [&](std::uint32_t i, const Mask& here) {
                        const FacetPlane p = FacetCode::plane(tree, i);
                        const F32 z = to_f32(splat(p.a) * X + (splat(p.b) * Y + splat(p.c)));
                        const F32 least = splat(p.zmin), most = splat(p.zmax);
                        const F32 low = select(less(z, most), z, most);
                        depth = select(here, select(less(least, low), low, least), depth);
                    });
    const I32 cap = shift_right<20>(value) & splat(std::int32_t{31});
    const I32 ramp = shift_right<25>(value) & splat(std::int32_t{63});
    const I32 no_cap = splat(static_cast<std::int32_t>(facet_no_cap));
    const F32 most = select(equal(cap, no_cap), splat(0.0f), facet_powers(cap + splat(std::int32_t{1})));
    const F32 rise = select(less(splat(0.0f), beyond), beyond, splat(0.0f)) * facet_powers(ramp);
    const Mask ramped = ~equal(ramp, splat(static_cast<std::int32_t>(facet_no_ramp)));
    const F32 offset = select(ramped & less(rise, most), rise, most);
    const F32 behind = depth + offset;
    return select(planes, select(less(behind, splat(1.0f)), behind, splat(1.0f)), depth);
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
