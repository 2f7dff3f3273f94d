#pragma once
// The code mmh: merged multiresolution hierarchies.
//
// L. Scandolo, P. Bauszat, E. Eisemann, "Merged Multiresolution Hierarchies for Shadow Map Compression",
// Pacific Graphics 2016.

#include <cstdint>
#include <string>

#include "core/types.h"
#include "hierarchy/build_memory.h"
#include "hierarchy/encode_params.h"
#include "hierarchy/mmh/merge.h"
#include "hierarchy/multires.h"
#include "hierarchy/shadow_tree.h"

namespace obscura {

/// Serialises a quadtree whose nodes' intervals are there, with subtrees that can be one merged. Every
/// texel's decoded depth lies in the interval that its value has in `tree`. Memory: mmh_construction_bytes a
/// node. Time: O(nodes) without the search, which compares each subtree with up to params.merge.search_limit
/// others. LimitError when it takes more than params.max_units words or has more than 2^32 groups. The same
/// bytes for any exec. Without the top grid. `stats`: what was compared, when wanted.
ShadowTree encode_mmh(const MultiresTree& tree, const LightView& view, const EncodeParams& params,
                      MergeStats* stats);
ShadowTree encode_mmh(const MultiresTree& tree, const LightView& view, const EncodeParams& params);

/// What is wrong with a tree from outside, or null: as mh_fault_of(), where nodes may be shared, and what the
/// values of every way add up to is a depth. Its counts are of the nodes that are stored. O(words).
const char* mmh_fault_of(const ShadowTree& tree);

/// "differences of fractions"
std::string mmh_text(const ShadowTree& tree);

/// A node and its interval while trees are made, and while they are merged: its part of a subtree, two of
/// ranges and values, its number in lists, and its bytes.
constexpr std::int64_t mmh_construction_bytes = node_construction_bytes +
                                                2 * std::int64_t{sizeof(DepthInterval)} +
                                                std::int64_t{sizeof(Subtree)} + 3 * 8 + 16;

}  // namespace obscura
