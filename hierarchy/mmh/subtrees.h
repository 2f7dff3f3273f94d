#pragma once
// A tree as what can be merged: subtrees, their topology, and the depths that their values may be.
//
// L. Scandolo, P. Bauszat, E. Eisemann, "Merged Multiresolution Hierarchies for Shadow Map Compression",
// Pacific Graphics 2016, section 3.1: a subtree is a group of siblings with all that hangs below it; one
// parent node points to it. The kind of the parent is not part of it.
//
// Subtrees stand in depth-first order, parents before children: all groups of a subtree are neighbours, and
// so are all its values, which makes a comparison of two subtrees a walk over two arrays.

#include <array>
#include <cstdint>
#include <vector>

#include "hierarchy/multires.h"
#include "hierarchy/number_range.h"

namespace obscura {

constexpr std::uint32_t no_subtree = 0xffffffffu, no_value = 0xffffffffu;

struct Subtree {
    std::uint32_t groups = 1;           ///< in it, its own first
    std::uint32_t first_value = 0;      ///< of its values, in SubtreeSet::values: its own group's come first
    std::uint32_t values = 0;           ///< how many, in all its groups
    std::uint32_t parent = no_subtree;  ///< that holds the parent node; no_subtree: the root is the parent
    std::uint32_t parent_value = no_value;  ///< the parent's own value; no_value: it is an empty node
    std::uint32_t topology = 0;             ///< equal for two subtrees when all their nodes' kinds are
    std::uint64_t unit = 0;   ///< words before it when nothing is merged: depth-first, in child order
    std::uint8_t kinds = 0;   ///< of its own group's four nodes
    std::uint8_t height = 1;  ///< groups on its longest way down
    std::uint8_t level = 0;   ///< height of its own group's nodes above the texels
};

struct SubtreeSet {
    int levels = 0;
    MultiresNode root;
    std::vector<Subtree> subtrees;    ///< depth-first; the first is the root's, if it has children
    std::vector<NumberRange> values;  ///< 0: the root's; then as Subtree says
    TreeLayout layout = TreeLayout::fractions;
    std::uint32_t topologies = 0;  ///< different ones
};

/// `tree` must have its nodes' intervals. Numbers are fractions, or float bits where one interval holds no
/// fraction or `layout` asks for them. LimitError beyond 2^32 - 1 values or groups.
SubtreeSet subtrees_of(const MultiresTree& tree, TreeLayout layout = TreeLayout::fractions);

}  // namespace obscura
