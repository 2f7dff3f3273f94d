#pragma once
// The code dag: a directed acyclic graph for the structure, chunks for the values.
//
// L. Scandolo, E. Eisemann, "Directed Acyclic Graph Encoding for Compressed Shadow Maps", High-Performance
// Graphics 2021.

#include <cstdint>
#include <string>

#include "core/types.h"
#include "hierarchy/build_memory.h"
#include "hierarchy/dag/topology.h"
#include "hierarchy/encode_params.h"
#include "hierarchy/multires.h"
#include "hierarchy/shadow_tree.h"

namespace obscura {

/// What a tree came to; the paper's tables 3 and 4.
struct DagStats {
    std::uint64_t inner_nodes = 0, inner_bytes = 0;
    std::uint64_t treelets = 0, treelet_bytes = 0;
    std::uint64_t values = 0;
    std::uint64_t chunk_bytes = 0;  ///< of the records
    /// Values that have one, and all their bytes. Packed: what is in chunks, and chunks of one to four
    /// classes.
    std::uint64_t factors = 0, factor_bytes = 0;
    std::uint64_t classes[4] = {};
    std::uint64_t structure_bytes() const { return inner_bytes + treelet_bytes; }
    std::uint64_t value_bytes() const { return chunk_bytes + factor_bytes; }
};

/// Of a tree of this code.
DagStats dag_stats(const ShadowTree& tree);

/// Serialises a quadtree whose nodes' intervals are there. Every texel's decoded depth lies in the interval
/// that its value has in `tree`, and the graph unfolds to the tree's own nodes. Memory:
/// dag_construction_bytes a node. Time: O(nodes). LimitError beyond 2^31 values, 2^30 bytes of factors that
/// are not packed, or when it takes more than 2^32 bytes or params.max_units words. The same bytes for any
/// exec. Without the top grid.
ShadowTree encode_dag(const MultiresTree& tree, const LightView& view, const EncodeParams& params);

/// What is wrong with a tree from outside, or null: as mh_fault_of(), where nodes may be shared; numbers of
/// values are those of the nodes, so that every lookup names one, and every one is a depth. O(words).
const char* dag_fault_of(const ShadowTree& tree);

/// "2041 nodes, 5683 treelets of 4 levels, 11.9 bits a value"
std::string dag_text(const ShadowTree& tree);

/// A node and its interval while trees are made, and while they are written: its range, its level, its part
/// of nodes and treelets and the tables that find them, and its bytes.
constexpr std::int64_t dag_construction_bytes =
    node_construction_bytes + 2 * std::int64_t{sizeof(DepthInterval)} + std::int64_t{sizeof(NumberRange)} +
    1 + std::int64_t{sizeof(DagNode)} + 64 + 8;

}  // namespace obscura
