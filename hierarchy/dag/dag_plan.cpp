#include "hierarchy/dag/dag_plan.h"

namespace obscura {
namespace {

/// Packed: half-words of node i, when those behind it stand `from_end` before the end of all nodes, as
/// `node_from_end` tells. Pointers that become long make others longer, so it is looked at again.
std::uint64_t packed_units(const DagTopology& dag, std::size_t i, std::uint64_t end,
                           const std::vector<std::uint64_t>& node_from_end) {
    const DagNode& node = dag.nodes[i];
    const std::uint64_t head = node.values < packed_count_escape ? 1 : 3;
    std::uint64_t units = head + node.children();
    for (;;) {
        std::uint64_t needed = head;
        for (int c = 0; c < 4; ++c) {
            const DagKind kind = node.kind(c);
            if (kind == DagKind::none) continue;
            const std::uint64_t place =
                kind == DagKind::treelet ? node.child[c] : end + units - node_from_end[node.child[c]];
            needed += is_long_place(place) ? 2 : 1;
        }
        if (needed == units) return units;
        units = needed;
    }
}

}  // namespace

DagPlan plan_of(const DagTopology& dag, const DagForm& form) {
    DagPlan plan;
    plan.form = form;
    // The first that was finished stands last; places are counted from the end until all is known.
    std::vector<std::uint64_t> from_end(dag.nodes.size());
    std::uint64_t end = 0;
    for (std::size_t i = 0; i < dag.nodes.size(); ++i) {
        end +=
            form.packed ? packed_units(dag, i, end, from_end) : form.node_units() + dag.nodes[i].children();
        from_end[i] = end;
    }
    const std::uint64_t per_word = form.packed ? 2 : 1, first = dag_header_words * per_word;
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
