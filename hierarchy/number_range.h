#pragma once
// The whole numbers that a value may be (fixed_depth.h).

#include <cstdint>
#include <vector>

#include "hierarchy/multires.h"
#include "hierarchy/tree_code.h"

namespace obscura {

/// least <= greatest: all of them become depths of one interval. Otherwise: none.
struct NumberRange {
    std::uint32_t least = 0, greatest = 0;
    bool empty() const { return least > greatest; }
    friend bool operator==(const NumberRange&, const NumberRange&) = default;
};

/// All numbers, and no others, whose depths lie in the interval. `layout`: fractions or float_bits, with
/// which no range is empty.
NumberRange range_of(DepthInterval interval, TreeLayout layout);

/// Fractions where every interval of the tree, whose nodes' intervals must be there, holds one and `wanted`
/// is that; else float bits.
TreeLayout numbers_that_hold(const MultiresTree& tree, TreeLayout wanted);

/// The number that is written for a range: that of the depth that stored_depth() takes of an interval, as
/// near as can be.
std::uint32_t stored_number(NumberRange range, TreeLayout layout);

}  // namespace obscura
