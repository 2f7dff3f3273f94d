#pragma once
// A step of sixteen descents through a merged tree. Kernel files only; the meaning is MmhCode::child() in
// hierarchy/mmh/mmh_step.h.
//
// Lanes carry sums from 2^31 on, as they carry indices: adding a difference does not mind.

#include "hierarchy/descents.h"
#include "hierarchy/mmh/mmh_step.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// One level down, from nodes of height `height` (>= 1) to the children that child_bit() names.
OBSCURA_INLINE void descend(MmhCode, const TreeCode& tree, const std::uint8_t* base, int height,
                            const I32& bit, Numbers16<false>& d) {
    const I32 header = gather_bytes<4>(base, d.node);
    const I32 kind = shift_right_logical(header, bit);
    const I32 below = header & shift_right_logical(splat(std::int32_t{0x3f}), splat(std::int32_t{6}) - bit);
    I32 offset = shift_right_logical<8>(header);
    const std::uint32_t scale = tree.offset_scale[height];
    if (scale != 1) offset = offset * splat(static_cast<std::int32_t>(scale));
    const I32 child = d.node + offset + units_of<MmhCode>(below);

    const Mask has_value = d.inner & any_bit(kind, splat(std::int32_t{1}));
    d.inner = d.inner & any_bit(kind, splat(std::int32_t{2}));
    if (any(has_value)) {
        // A node with children has a header before its value. Lanes without a value read their node again.
        const I32 place = child + select(d.inner, splat(std::int32_t{1}), splat(std::int32_t{0}));
        const I32 difference = gather_bytes<4>(base, select(has_value, place, d.node));
        d.value = d.value + select(has_value, difference, splat(std::int32_t{0}));
    }
    d.node = select(d.inner, child, d.node);
}

OBSCURA_INLINE F32 values(MmhCode, const TreeCode& tree, const std::uint8_t*, const Numbers16<false>& d) {
    return depths_of(tree.layout, d.value ^ splat(biased(0)));
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
