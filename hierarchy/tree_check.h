#pragma once
// Whether a serialised tree is sound, for trees that come from outside.

#include <cstdint>

#include "hierarchy/multires.h"
#include "hierarchy/tree_code.h"

namespace obscura {

/// Walks a tree of `units` units and returns what is wrong with it, or null. When nothing is: every node and
/// value that a descent can meet lies inside the units, no node is inner at the height of texels, children
/// follow their parents, offsets have the layout's bits, values are depths in [0, 1], and the tree has
/// `counts` nodes. O(units), even for trees whose nodes share children to make it longer. Reads `code`, but
/// not its top grid; code.levels must be in [0, 20].
const char* fault_of(const TreeCode& code, std::uint64_t units, const MultiresCounts& counts);

}  // namespace obscura
