#pragma once
// Whether a serialised octree is sound, for stacks that come from outside.

#include <cstdint>

#include "hierarchy/multires.h"
#include "hierarchy/stack/stack_code.h"

namespace obscura {

/// Most maps of a stack, as a power of two: shares of light are counted in 16 bits.
constexpr int max_slice_levels = 15;

/// What is wrong with a shape, or null.
const char* fault_of(const StackShape& shape);

/// Walks an octree of `words` words and returns what is wrong with it, or null. When nothing is: every node
/// and value that a descent can meet lies inside the words, no node is inner at the height of texels, axes
/// that are not divided have no second halves, children follow their parents, values are depths in [0, 1],
/// and the octree has `counts` nodes. O(words), even for octrees whose nodes share children to make them
/// longer. The shape must be sound.
const char* fault_of(const StackCode& code, std::uint64_t words, const MultiresCounts& counts);

}  // namespace obscura
