#pragma once
// Which parts of a far field are bright enough to be worth computing.

#include "optics/field/separable_field.h"

namespace obscura {

/// What decides that a block is dark.
enum class CullTest {
    with_neighbours,  ///< value_and_slope of the block itself and of the eight around it
    value_and_slope,  ///< |F| at its centre plus half a block's width times the derivatives: misses a few
    value,            ///< |F| at its centre alone: misses half of the bright blocks; for comparison
};

/// Blocks of 8 x 8 pixels in which |F| may exceed `amplitude`.
BlockSet bright_blocks(const SeparableTerms& terms, const FrequencyGrid& grid, double amplitude,
                       CullTest test, const Exec& exec);

/// Number of blocks in the set.
std::int64_t active_count(const BlockSet& blocks);

}  // namespace obscura
