#pragma once
// Sixteen descents through a serialised tree at once, all at the same height: what every code's steps share.
// Kernel files only.
//
// Unit indices have 32 bits, but gathers take signed ones: lanes carry index - 2^31, and the base points 2^31
// units beyond the tree's. What is carried of values is a 32-bit number from 2^31 on, too.

#include "core/simd.h"
#include "hierarchy/tree_code.h"

namespace obscura::OBSCURA_ISA {
namespace {

constexpr std::uint32_t index_bias = 0x80000000u;

OBSCURA_INLINE std::int32_t biased(std::uint32_t index) {
    return static_cast<std::int32_t>(index ^ index_bias);
}

/// The numbers of sixteen places (TreePlace). `counted`: the last two as well.
template <bool counted>
struct Numbers16 {
    I32 node;    ///< biased; where `inner` is clear, some node that was met before
    I32 value;   ///< biased
    Mask inner;  ///< lanes that go on
};
template <>
struct Numbers16<true> {
    I32 node, value;
    Mask inner;
    I32 count, inside;  ///< not biased; what else `inside` holds is the code's affair
};
template <class Code>
using Descents16 = Numbers16<Code::counts_values>;

/// All lanes at one place.
template <class Code>
OBSCURA_INLINE Descents16<Code> descents_from(const TreePlace& place, const Mask& active) {
    const bool ended = place.node == no_tree_node;
    const I32 node = splat(ended ? biased(0) : biased(place.node)), value = splat(biased(place.value));
    const Mask inner = ended ? mask_of(0) : active;
    if constexpr (Code::counts_values) {
        return {node, value, inner, splat(static_cast<std::int32_t>(place.count)),
                splat(static_cast<std::int32_t>(place.inside))};
    } else {
        return {node, value, inner};
    }
}

OBSCURA_INLINE Mask select(const Mask& m, const Mask& a, const Mask& b) {
    return (m & a) | (~m & b);
}
template <bool counted>
OBSCURA_INLINE Numbers16<counted> select(const Mask& m, const Numbers16<counted>& a,
                                         const Numbers16<counted>& b) {
    Numbers16<counted> c = b;
    c.node = select(m, a.node, b.node);
    c.value = select(m, a.value, b.value);
    c.inner = select(m, a.inner, b.inner);
    if constexpr (counted) {
        c.count = select(m, a.count, b.count);
        c.inside = select(m, a.inside, b.inside);
    }
    return c;
}

template <class Code>
OBSCURA_INLINE const std::uint8_t* biased_units(const TreeCode& tree) {
    return reinterpret_cast<const std::uint8_t*>(reinterpret_cast<std::uintptr_t>(tree.units) +
                                                 std::uintptr_t{index_bias} * Code::unit_bytes);
}

/// Units of the siblings before a child, from the bits of their kinds.
template <class Code>
OBSCURA_INLINE I32 units_of(const I32& below) {
    constexpr std::uint8_t l = Code::low_bit, h = Code::high_bit;
    alignas(16) static constexpr std::uint8_t units[16] = {
        0, l,     h,     l + h,     l,     l + l,     l + h,     l + l + h,
        h, l + h, h + h, l + h + h, l + h, l + l + h, l + h + h, l + l + h + h};
    return small_table(units, below & splat(std::int32_t{15})) + small_table(units, shift_right<4>(below));
}

/// depth_of_fixed() of hierarchy/fixed_depth.h.
OBSCURA_INLINE F32 depths_of(TreeLayout layout, const I32& v) {
    if (layout == TreeLayout::float_bits) return bitcast_f32(v);
    return to_f32(shift_right_logical<16>(v)) * splat(0x1p-16f) +
           to_f32(v & splat(std::int32_t{0xffff})) * splat(0x1p-32f);
}

/// Which child holds texels (x, y), seen from nodes of height `height` (>= 1): the first bit of its kind.
OBSCURA_INLINE I32 child_bit(int height, const I32& x, const I32& y) {
    return (shift_right(shift_left<1>(x), height - 1) & splat(std::int32_t{2})) |
           (shift_right(shift_left<2>(y), height - 1) & splat(std::int32_t{4}));
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
