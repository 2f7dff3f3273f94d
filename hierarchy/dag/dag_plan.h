#pragma once
// Where the nodes of a graph stand.

#include <cstdint>
#include <vector>

#include "hierarchy/dag/dag_format.h"
#include "hierarchy/dag/topology.h"

namespace obscura {

/// Bytes of a packed node's numbers.
struct PackedSizes {
    std::uint32_t count = 1, pointer = 1;
};

struct DagPlan {
    DagForm form;
    std::vector<std::uint64_t> node_at;                                  ///< units of the form, by node
    std::vector<PackedSizes> sizes;                                      ///< packed: by node
    std::uint64_t first_treelet = 0, first_chunk = 0, first_factor = 0;  ///< words
};

/// Nodes in the reverse of the order in which they were finished: the root first, and every node in front
/// of all that hangs below it.
DagPlan plan_of(const DagTopology& dag, const DagForm& form);

}  // namespace obscura
