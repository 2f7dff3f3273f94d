#include "hierarchy/dag/dag_plan.h"

#include <algorithm>

namespace obscura {
namespace {

/// Packed: bytes of node i, behind which nodes take `end` bytes; node_from_end tells where each of these
/// begins, counted back from the end of all. The longer its pointers, the farther off its children, so
/// pointers of more bytes are tried until they reach.
std::uint64_t packed_bytes(const DagTopology& dag, std::size_t i, std::uint64_t end,
                           const std::vector<std::uint64_t>& node_from_end, PackedSizes& sizes) {
    const DagNode& node = dag.nodes[i];
    const std::uint64_t children = node.children();
    if (children == 0) return packed_node_bytes;
    sizes.count = bytes_of_number(node.before_last);
    for (sizes.pointer = 1;; ++sizes.pointer) {
        const std::uint64_t bytes =
            packed_node_bytes + (children - 1) * sizes.count + children * sizes.pointer;
        std::uint64_t farthest = 0;
        for (int c = 0; c < 4; ++c) {
            const DagKind kind = node.kind(c);
            if (kind == DagKind::none) continue;
            farthest =
                std::max(farthest, kind == DagKind::treelet ? std::uint64_t{node.child[c]}
                                                            : end + bytes - node_from_end[node.child[c]]);
        }
        // Four bytes reach wherever lookups do; what is farther is refused.
        if (bytes_of_number(farthest) <= sizes.pointer || sizes.pointer == 4) return bytes;
    }
}

}  // namespace

DagPlan plan_of(const DagTopology& dag, const DagForm& form) {
    DagPlan plan;
    plan.form = form;
    plan.sizes.resize(form.packed ? dag.nodes.size() : 0);
    // The first that was finished stands last; places are counted from the end until all is known.
    std::vector<std::uint64_t> from_end(dag.nodes.size());
    std::uint64_t end = 0;
    for (std::size_t i = 0; i < dag.nodes.size(); ++i) {
        end += form.packed ? packed_bytes(dag, i, end, from_end, plan.sizes[i])
                           : form.node_words() + dag.nodes[i].children();
        from_end[i] = end;
    }
    const std::uint64_t per_word = form.packed ? 4 : 1, first = dag_header_words * per_word;
    plan.node_at.resize(dag.nodes.size());
    for (std::size_t i = 0; i < dag.nodes.size(); ++i)
        plan.node_at[i] = first + end - from_end[i];

    plan.first_treelet = (first + end + per_word - 1) / per_word;
    plan.first_chunk = plan.first_treelet + dag.treelets.size() * treelet_words(form.treelet_levels);
    const std::uint64_t chunks = (dag.values.size() + (1u << form.chunk_log2) - 1) >> form.chunk_log2;
    plan.first_factor = plan.first_chunk + (chunks * form.chunk_bytes() + 3) / 4;
    return plan;
}

}  // namespace obscura
