#pragma once
// Sixteen descents through a serialised tree of any code. Kernel files only; the meaning of each step is
// Code::child() in hierarchy/codes/tree_step.h.
//
// A code gives, for Descents16 (hierarchy/descents.h), with its scalar twin as a tag:
//   descend(Code{}, tree, base, height, bit, d)   one level down, to the children that `bit` names
//   values(Code{}, tree, base, d)                 the depths that the values on the ways come to; where these
//                                                 vary, values(Code{}, tree, base, d, x, y)

#include "hierarchy/codes/tree_step.h"
#include "hierarchy/dag/dag_lanes.h"
#include "hierarchy/descents.h"
#include "hierarchy/facet/facet_lanes.h"
#include "hierarchy/mh/mh_lanes.h"
#include "hierarchy/mmh/mmh_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Down to nodes of height `stop`, or to where each lane ends.
template <class Code>
OBSCURA_INLINE void descend_to(const TreeCode& tree, const std::uint8_t* base, int height, int stop,
                               const I32& x, const I32& y, Descents16<Code>& d) {
    for (; height > stop && any(d.inner); --height)
        descend(Code{}, tree, base, height, child_bit(height, x, y), d);
}

/// depth_of() of hierarchy/codes/tree_step.h.
template <class Code>
OBSCURA_INLINE F32 values_of(const TreeCode& tree, const std::uint8_t* base, const Descents16<Code>& d,
                             const I32& x, const I32& y, int level) {
    if constexpr (Code::varies) {
        if (level == 0) return values(Code{}, tree, base, d, x, y);
        const I32 whole = splat(-(1 << level)), half = splat(1 << (level - 1));
        return values(Code{}, tree, base, d, (x & whole) | half, (y & whole) | half);
    } else {
        return values(Code{}, tree, base, d);
    }
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
