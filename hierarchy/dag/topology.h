#pragma once
// A tree's structure as a directed acyclic graph, and the ranges of its values in depth-first order.
//
// L. Scandolo, E. Eisemann, "Directed Acyclic Graph Encoding for Compressed Shadow Maps", High-Performance
// Graphics 2021, sections 3.1 and 3.2, after B. Dado et al., "Geometry and Attribute Compression for Voxel
// Scenes", Eurographics 2016: what hangs below two nodes is one where kinds agree all the way down, whatever
// the values are, since a value is found by how many stand before it.

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "hierarchy/dag/dag_format.h"
#include "hierarchy/multires.h"
#include "hierarchy/number_range.h"

namespace obscura {

/// Which nodes of a full tree have a value, depth-first: bit i % 32 of word i / 32.
struct Treelet {
    std::array<std::uint32_t, (full_tree_nodes(max_treelet_levels) + 31) / 32> bits = {};

    void set(std::uint32_t position) { bits[position / 32] |= 1u << position % 32; }
    std::uint32_t values() const {
        std::uint32_t count = 0;
        for (const std::uint32_t word : bits)
            count += static_cast<std::uint32_t>(std::popcount(word));
        return count;
    }
    friend bool operator==(const Treelet&, const Treelet&) = default;
};

/// What hangs below inner nodes, once for all that have the same.
struct DagNode {
    std::uint32_t kinds = 0;        ///< DagKind, two bits each
    std::uint32_t child[4] = {};    ///< of those that exist: index of a treelet, or of a node
    std::uint64_t values = 0;       ///< below it
    std::uint32_t before[4] = {};   ///< of these before each child that exists
    std::uint32_t before_last = 0;  ///< before the last
    DagKind kind(int i) const { return static_cast<DagKind>(kinds >> (2 * i) & 3u); }
    std::uint32_t children() const {
        return static_cast<std::uint32_t>(std::popcount((kinds | kinds >> 1) & 0x55u));
    }
};

struct DagTopology {
    int levels = 0;
    int treelet_levels = 0;
    TreeLayout layout = TreeLayout::fractions;  ///< of the ranges
    std::vector<DagNode> nodes;                 ///< children before parents; the last is the root
    std::vector<Treelet> treelets;              ///< those that most nodes point to first
    std::vector<NumberRange> values;            ///< depth-first; 0: the root's
};

/// `tree` must have its nodes' intervals. Subtrees of up to `treelet_levels` levels become treelets. Numbers
/// are fractions, or float bits where some interval holds no fraction or `layout` asks for them. Equal trees
/// give equal graphs. LimitError beyond 2^31 values.
DagTopology dag_topology(const MultiresTree& tree, int treelet_levels, TreeLayout layout);

}  // namespace obscura
