#pragma once
// The code mh: the serialised quadtree of hierarchy/tree_code.h.

#include <string>

#include "core/types.h"
#include "hierarchy/encode_params.h"
#include "hierarchy/multires.h"
#include "hierarchy/shadow_tree.h"

namespace obscura {

/// Serialises a quadtree, in time and memory O(nodes). When a layout's offsets cannot reach at a bearable
/// loss to padding, the next wider one is taken: bytes16, words16, words24 (see the tree's code.layout).
/// Throws LimitError when the tree has more than 2^31 words, which is what lookups can name. Padding is zero,
/// so equal trees give equal bytes. Without the top grid.
ShadowTree encode_mh(const MultiresTree& tree, const LightView& view, const EncodeParams& params);

/// What is wrong with a tree from outside, or null. When nothing is: every node and value that a descent can
/// meet lies inside the units, no node is inner at the height of texels, children follow their parents,
/// offsets have the layout's bits, values are depths in [0, 1], and nodes and padding are as stated.
/// O(bytes), even for trees whose nodes share children to make it longer. Its levels must be in [0, 20].
const char* mh_fault_of(const ShadowTree& tree);

/// The tree that was encoded, in the order that build_bottom_up() gives nodes; the root's interval is its
/// value alone.
MultiresTree decode_mh(const ShadowTree& tree);

/// "words24, padding 0.05 %"
std::string mh_text(const ShadowTree& tree);

}  // namespace obscura
