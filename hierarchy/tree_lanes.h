#pragma once
// Sixteen descents through a serialised tree at once, all at the same height. Kernel files only; the meaning
// of each step is tree_child() in hierarchy/tree_step.h.
//
// Unit indices have 32 bits, but gathers take signed ones: lanes carry index - 2^31, and the base points 2^31
// units beyond the tree's.

#include "core/simd.h"
#include "hierarchy/tree_step.h"

namespace obscura::OBSCURA_ISA {
namespace {

constexpr std::uint32_t index_bias = 0x80000000u;

OBSCURA_INLINE std::int32_t biased(std::uint32_t index) {
    return static_cast<std::int32_t>(index ^ index_bias);
}

struct Descents16 {
    I32 node;    ///< biased; where `inner` is clear, some node that was met before
    I32 value;   ///< biased place of the last value met
    Mask inner;  ///< lanes that go on
};

/// All lanes at one place.
OBSCURA_INLINE Descents16 descents_from(TopNode place, const Mask& active) {
    const bool ended = place.node == no_tree_node;
    return {splat(ended ? biased(0) : biased(place.node)), splat(biased(place.value)),
            ended ? mask_of(0) : active};
}

template <class Units>
OBSCURA_INLINE const std::uint8_t* biased_units(const TreeCode& tree) {
    return reinterpret_cast<const std::uint8_t*>(reinterpret_cast<std::uintptr_t>(tree.units) +
                                                 std::uintptr_t{index_bias} * Units::unit_bytes);
}

/// Units of the siblings before a child, from the bits of their kinds.
template <class Units>
OBSCURA_INLINE I32 units_of(const I32& below) {
    constexpr std::uint8_t l = Units::low_bit, h = Units::high_bit;
    alignas(16) static constexpr std::uint8_t units[16] = {
        0, l,     h,     l + h,     l,     l + l,     l + h,     l + l + h,
        h, l + h, h + h, l + h + h, l + h, l + l + h, l + h + h, l + l + h + h};
    return small_table(units, below & splat(std::int32_t{15})) + small_table(units, shift_right<4>(below));
}

/// Which child holds texels (x, y), seen from nodes of height `height` (>= 1): the first bit of its kind.
OBSCURA_INLINE I32 child_bit(int height, const I32& x, const I32& y) {
    return (shift_right(shift_left<1>(x), height - 1) & splat(std::int32_t{2})) |
           (shift_right(shift_left<2>(y), height - 1) & splat(std::int32_t{4}));
}

/// One level down, from nodes of height `height` (>= 1) to the children that child_bit() names.
template <class Units>
OBSCURA_INLINE void descend(const TreeCode& tree, const std::uint8_t* base, int height, const I32& bit,
                            Descents16& d) {
    const I32 header = gather_bytes<static_cast<int>(Units::unit_bytes)>(base, d.node);
    const I32 kind = shift_right_logical(header, bit);
    const I32 below = header & shift_right_logical(splat(std::int32_t{0x3f}), splat(std::int32_t{6}) - bit);
    I32 offset = shift_right_logical<8>(header);
    if constexpr (Units::offset_mask != 0xffffffu) {
        offset = offset & splat(static_cast<std::int32_t>(Units::offset_mask));
    }
    const std::uint32_t scale = tree.offset_scale[height];
    if (scale != 1) offset = offset * splat(static_cast<std::int32_t>(scale));
    const I32 child = d.node + offset + units_of<Units>(below);

    const Mask has_value = d.inner & any_bit(kind, splat(std::int32_t{1}));
    d.inner = d.inner & any_bit(kind, splat(std::int32_t{2}));
    // A node with children has a header before its value.
    constexpr auto step = static_cast<std::int32_t>(Units::header);
    const I32 value = child + select(d.inner, splat(step), splat(std::int32_t{0}));
    d.value = select(has_value, value, d.value);
    d.node = select(d.inner, child, d.node);
}

/// Down to nodes of height `stop`, or to where each lane ends.
template <class Units>
OBSCURA_INLINE void descend_to(const TreeCode& tree, const std::uint8_t* base, int height, int stop,
                               const I32& x, const I32& y, Descents16& d) {
    for (; height > stop && any(d.inner); --height)
        descend<Units>(tree, base, height, child_bit(height, x, y), d);
}

template <class Units>
OBSCURA_INLINE F32 values(const std::uint8_t* base, const Descents16& d) {
    return bitcast_f32(gather_bytes<static_cast<int>(Units::unit_bytes)>(base, d.value));
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
