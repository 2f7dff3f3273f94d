#include "hierarchy/mmh/subtrees.h"

#include <algorithm>
#include <unordered_map>

#include "core/error.h"
#include "core/hash.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

constexpr std::uint32_t empty_kind = static_cast<std::uint32_t>(ChildKind::empty);

/// Numbers topologies: kinds of a group, and the numbers of what hangs below its inner nodes. Equal numbers
/// are equal topologies, not just equal hashes.
class TopologyTable {
  public:
    using Key = std::array<std::uint32_t, 5>;

    std::uint32_t number_of(const Key& key) {
        return numbers_.emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
    }
    std::uint32_t size() const { return static_cast<std::uint32_t>(numbers_.size()); }

  private:
    struct Hash {
        std::size_t operator()(const Key& key) const { return Hasher{}.value(key).state; }
    };
    std::unordered_map<Key, std::uint32_t, Hash> numbers_;
};

class Flattener {
  public:
    Flattener(const MultiresTree& tree, SubtreeSet& set) : tree_(tree), set_(set) {}

    void run() {
        set_.levels = tree_.levels;
        set_.root = tree_.root;
        add_value(tree_.root_interval);
        units_ = units_of_kinds(TreeLayout::words24)[3];
        if (tree_.root.kinds != 0) add(tree_.root, tree_.levels - 1, no_subtree, 0);
        set_.topologies = table_.size();
    }

  private:
    void add_value(DepthInterval interval) {
        if (set_.values.size() >= no_value) throw LimitError("a merged tree of more than 2^32 values");
        set_.values.push_back(range_of(interval, set_.layout));
    }

    /// The subtree below a node; recursion is as deep as the tree is high.
    std::uint32_t add(const MultiresNode& parent, int level, std::uint32_t above,
                      std::uint32_t parent_value) {
        if (set_.subtrees.size() >= no_subtree) throw LimitError("a merged tree of more than 2^32 groups");
        const auto at = static_cast<std::uint32_t>(set_.subtrees.size());
        Subtree own;
        own.kinds = static_cast<std::uint8_t>(parent.kinds);
        own.level = static_cast<std::uint8_t>(level);
        own.parent = above;
        own.parent_value = parent_value;
        own.unit = units_;
        own.first_value = static_cast<std::uint32_t>(set_.values.size());
        units_ += units_before(units_of_kinds(TreeLayout::words24), own.kinds, 4);
        set_.subtrees.push_back(own);

        std::uint32_t value_of[4] = {no_value, no_value, no_value, no_value};
        std::uint64_t node = parent.first_child();
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t kind = kind_of(own.kinds, i);
            if ((kind & 1u) != 0) {
                value_of[i] = static_cast<std::uint32_t>(set_.values.size());
                add_value(tree_.intervals[node]);
            }
            node += kind != 0;
        }
        TopologyTable::Key key{own.kinds};
        std::uint8_t height = 1;
        node = parent.first_child();
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t kind = kind_of(own.kinds, i);
            if (kind >= empty_kind) {
                const std::uint32_t below = add(tree_.nodes[node], level - 1, at, value_of[i]);
                key[static_cast<std::size_t>(i) + 1] = set_.subtrees[below].topology;
                height = std::max<std::uint8_t>(height,
                                                static_cast<std::uint8_t>(set_.subtrees[below].height + 1));
            }
            node += kind != 0;
        }
        Subtree& done = set_.subtrees[at];
        done.height = height;
        done.groups = static_cast<std::uint32_t>(set_.subtrees.size() - at);
        done.values = static_cast<std::uint32_t>(set_.values.size() - done.first_value);
        done.topology = table_.number_of(key);
        return at;
    }

    const MultiresTree& tree_;
    SubtreeSet& set_;
    TopologyTable table_;
    std::uint64_t units_ = 0;
};

}  // namespace

SubtreeSet subtrees_of(const MultiresTree& tree, TreeLayout layout) {
    CHECK(tree.dimensions == 2 && tree.levels >= 0 && tree.levels <= max_tree_levels);
    CHECK(tree.intervals.size() == tree.nodes.size(), "merging needs the nodes' intervals");
    SubtreeSet set;
    set.layout = numbers_that_hold(tree, layout);
    set.values.reserve(tree.nodes.size() + 1);
    Flattener(tree, set).run();
    return set;
}

}  // namespace obscura
