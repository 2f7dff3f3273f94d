#pragma once
// Plain reading of serialised trees: for inspection, for tests, and for the dense top grid.
//
// Lookups by the million are in query.h; these are single ones of any code.

#include <cstdint>

#include "hierarchy/shadow_tree.h"
#include "hierarchy/tree_code.h"

namespace obscura {

/// Value of texel (x, y), both below 2^levels, by descent from the root. Does not use the top grid.
float tree_value(const TreeCode& tree, std::uint32_t x, std::uint32_t y);

/// The same descent, stopped at squares of 2^level texels a side (level in [0, levels]; 0: at the texel): the
/// value that the square containing texel (x, y) stands for.
float tree_value_at_level(const TreeCode& tree, std::uint32_t x, std::uint32_t y, int level);

/// Value of texel (x, y) by a descent that starts in the top grid, which must be there.
float tree_value_from_top(const TreeCode& tree, std::uint32_t x, std::uint32_t y);

/// Gives `tree` a dense top grid over its first `top_levels` levels, in [0, min(levels, max_top_levels)]; 0
/// takes it away. O(4^top_levels).
void set_top_grid(ShadowTree& tree, int top_levels);

}  // namespace obscura
