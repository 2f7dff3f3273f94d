#pragma once
// A step of sixteen descents through a tree of the code mh. Kernel files only; the meaning is MhCode::child()
// in hierarchy/mh/mh_step.h.

#include "hierarchy/descents.h"
#include "hierarchy/mh/mh_step.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// One level down, from nodes of height `height` (>= 1) to the children that child_bit() names.
template <TreeLayout layout>
OBSCURA_INLINE void descend(MhCode<layout>, const TreeCode& tree, const std::uint8_t* base, int height,
                            const I32& bit, Numbers16<false>& d) {
    using Code = MhCode<layout>;
    const I32 header = gather_bytes<static_cast<int>(Code::unit_bytes)>(base, d.node);
    const I32 kind = shift_right_logical(header, bit);
    const I32 below = header & shift_right_logical(splat(std::int32_t{0x3f}), splat(std::int32_t{6}) - bit);
    I32 offset = shift_right_logical<8>(header);
    if constexpr (Code::offset_mask != 0xffffffu) {
        offset = offset & splat(static_cast<std::int32_t>(Code::offset_mask));
    }
    const std::uint32_t scale = tree.offset_scale[height];
    if (scale != 1) offset = offset * splat(static_cast<std::int32_t>(scale));
    const I32 child = d.node + offset + units_of<Code>(below);

    const Mask has_value = d.inner & any_bit(kind, splat(std::int32_t{1}));
    d.inner = d.inner & any_bit(kind, splat(std::int32_t{2}));
    // A node with children has a header before its value.
    constexpr auto step = static_cast<std::int32_t>(Code::header);
    const I32 value = child + select(d.inner, splat(step), splat(std::int32_t{0}));
    d.value = select(has_value, value, d.value);
    d.node = select(d.inner, child, d.node);
}

template <TreeLayout layout>
OBSCURA_INLINE F32 values(MhCode<layout>, const TreeCode&, const std::uint8_t* base,
                          const Numbers16<false>& d) {
    return bitcast_f32(gather_bytes<static_cast<int>(MhCode<layout>::unit_bytes)>(base, d.value));
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
