#include "hierarchy/dag/topology.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "core/error.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

constexpr std::uint64_t most_values = std::uint64_t{1} << 31;

/// Numbers things by their contents, in the order in which they are first seen: which hash is taken changes
/// nothing.
template <std::size_t words>
class NumberTable {
  public:
    using Key = std::array<std::uint32_t, words>;

    /// The number of `key`, and whether it is new.
    std::pair<std::uint32_t, bool> number_of(const Key& key) {
        const auto [at, added] = numbers_.emplace(key, static_cast<std::uint32_t>(numbers_.size()));
        return {at->second, added};
    }

  private:
    struct Hash {
        std::size_t operator()(const Key& key) const {
            std::uint64_t h = 0;
            for (const std::uint32_t word : key) {
                h = (h ^ word) * 0x9e3779b97f4a7c15u;
                h ^= h >> 32;
            }
            return h;
        }
    };
    std::unordered_map<Key, std::uint32_t, Hash> numbers_;
};

/// Levels of nodes from each node down, itself included. Groups of siblings stand before their parents.
std::vector<std::uint8_t> levels_of(const MultiresTree& tree) {
    std::vector<std::uint8_t> levels(tree.nodes.size(), 1);
    for (std::size_t at = 0; at < tree.nodes.size(); ++at) {
        const MultiresNode& node = tree.nodes[at];
        std::uint64_t child = node.first_child();
        for (int i = 0; i < 4; ++i) {
            if (node.child(i) == ChildKind::none) continue;
            CHECK(child < at, "children stand before their parents");
            levels[at] = std::max<std::uint8_t>(levels[at], static_cast<std::uint8_t>(levels[child++] + 1));
        }
    }
    return levels;
}

class Merger {
  public:
    Merger(const MultiresTree& tree, DagTopology& dag) : tree_(tree), levels_(levels_of(tree)), dag_(dag) {}

    void run() {
        add_value(tree_.root_interval);
        const std::uint32_t root = node_below(tree_.root);
        CHECK(root + 1 == dag_.nodes.size(), "the root is like no node below it");
        sort_treelets();
    }

  private:
    void add_value(DepthInterval interval) {
        if (dag_.values.size() >= most_values) throw LimitError("a shadow tree of more than 2^31 values");
        dag_.values.push_back(range_of(interval, dag_.layout));
    }

    /// What hangs below an inner node; recursion is as deep as the tree is high.
    std::uint32_t node_below(const MultiresNode& parent) {
        DagNode node;
        const std::size_t before = dag_.values.size();
        std::uint64_t child = parent.first_child();
        for (int i = 0; i < 4; ++i) {
            const ChildKind kind = parent.child(i);
            if (kind == ChildKind::none) continue;
            node.before[i] = node.before_last = static_cast<std::uint32_t>(dag_.values.size() - before);
            if (levels_[child] <= dag_.treelet_levels) {
                node.kinds |= static_cast<std::uint32_t>(DagKind::treelet) << (2 * i);
                node.child[i] = treelet_at(child, kind);
            } else {
                const bool full = kind == ChildKind::full;
                node.kinds |= static_cast<std::uint32_t>(full ? DagKind::full : DagKind::empty) << (2 * i);
                if (full) add_value(tree_.intervals[child]);
                node.child[i] = node_below(tree_.nodes[child]);
            }
            ++child;
        }
        node.values = dag_.values.size() - before;
        const auto [number, added] =
            nodes_.number_of({node.kinds, node.child[0], node.child[1], node.child[2], node.child[3]});
        if (added) dag_.nodes.push_back(node);
        return number;
    }

    std::uint32_t treelet_at(std::uint64_t node, ChildKind kind) {
        Treelet treelet;
        fill(treelet, node, kind, dag_.treelet_levels, 0);
        const auto [number, added] = treelets_.number_of(treelet.bits);
        if (added) dag_.treelets.push_back(treelet);
        return number;
    }

    /// The node and all below it, whose first stands at `position` of a full tree; `levels` of it fit.
    void fill(Treelet& treelet, std::uint64_t at, ChildKind kind, int levels, std::uint32_t position) {
        if (kind != ChildKind::empty) {
            treelet.set(position);
            add_value(tree_.intervals[at]);
        }
        const MultiresNode& node = tree_.nodes[at];
        std::uint64_t child = node.first_child();
        for (int i = 0; i < 4; ++i) {
            if (node.child(i) == ChildKind::none) continue;
            const std::uint32_t first =
                position + 1 + static_cast<std::uint32_t>(i) * full_tree_nodes(levels - 1);
            fill(treelet, child++, node.child(i), levels - 1, first);
        }
    }

    /// Those that most nodes point to get the lowest numbers; of as many, the first met.
    void sort_treelets() {
        std::vector<std::uint64_t> uses(dag_.treelets.size(), 0);
        const auto each_treelet = [&](const auto& visit) {
            for (DagNode& node : dag_.nodes) {
                for (int i = 0; i < 4; ++i) {
                    if (node.kind(i) == DagKind::treelet) visit(node.child[i]);
                }
            }
        };
        each_treelet([&](std::uint32_t treelet) { ++uses[treelet]; });
        std::vector<std::uint32_t> order(uses.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return uses[a] > uses[b]; });
        std::vector<std::uint32_t> number(uses.size());
        std::vector<Treelet> sorted;
        sorted.reserve(order.size());
        for (const std::uint32_t treelet : order) {
            number[treelet] = static_cast<std::uint32_t>(sorted.size());
            sorted.push_back(dag_.treelets[treelet]);
        }
        dag_.treelets = std::move(sorted);
        each_treelet([&](std::uint32_t& treelet) { treelet = number[treelet]; });
    }

    const MultiresTree& tree_;
    const std::vector<std::uint8_t> levels_;  ///< by node
    DagTopology& dag_;
    NumberTable<5> nodes_;
    NumberTable<std::tuple_size_v<decltype(Treelet::bits)>> treelets_;
};

}  // namespace

DagTopology dag_topology(const MultiresTree& tree, int treelet_levels, TreeLayout layout) {
    CHECK(tree.dimensions == 2 && tree.levels >= 0 && tree.levels <= max_tree_levels);
    CHECK(tree.intervals.size() == tree.nodes.size(), "a graph's values need the nodes' intervals");
    CHECK(treelet_levels >= min_treelet_levels && treelet_levels <= max_treelet_levels);
    DagTopology dag;
    dag.levels = tree.levels;
    dag.treelet_levels = treelet_levels;
    dag.layout = numbers_that_hold(tree, layout);
    dag.values.reserve(tree.nodes.size() + 1);
    Merger(tree, dag).run();
    return dag;
}

}  // namespace obscura
