#include "hierarchy/multires.h"

#include <algorithm>
#include <bit>

#include "hierarchy/combine.h"

namespace obscura {
namespace {

void count(const MultiresTree& tree, const MultiresNode& node, MultiresCounts& counts) {
    std::uint64_t next = node.first_child();
    for (int i = 0; i < 1 << tree.dimensions; ++i) {
        const ChildKind kind = node.child(i);
        if (kind == ChildKind::none) continue;
        counts.leaf += kind == ChildKind::leaf;
        counts.empty += kind == ChildKind::empty;
        counts.full += kind == ChildKind::full;
        count(tree, tree.nodes[next++], counts);
    }
}

int levels_of(ImageView<const DepthInterval> intervals) {
    CHECK(intervals.width == intervals.height && std::has_single_bit(static_cast<unsigned>(intervals.width)),
          "a hierarchy needs a square power-of-two map");
    return std::countr_zero(static_cast<unsigned>(intervals.width));
}

using Quadtree = MultiresBuilder<2>;

Quadtree::Part bottom_up(ImageView<const DepthInterval> intervals, int x, int y, int side,
                         Quadtree& builder) {
    if (side == 1) return Quadtree::texel(intervals(x, y));
    const int half = side / 2;
    const Quadtree::Part child[4] = {bottom_up(intervals, x, y, half, builder),
                                     bottom_up(intervals, x + half, y, half, builder),
                                     bottom_up(intervals, x, y + half, half, builder),
                                     bottom_up(intervals, x + half, y + half, half, builder)};
    return builder.join(child);
}

/// One end of a texel's interval, for the sweep.
struct IntervalEnd {
    float depth;
    bool exit;
    std::uint32_t texel;  ///< y * width + x
};

/// Top-down construction with the ends of all intervals sorted once; quadrants extract theirs in order.
///
/// The paper's algorithm 1 hands only the intervals that are still uncovered to a quadrant. But a texel that
/// an ancestor's value covers is decoded with the last value on its path, so a quadrant's own value must suit
/// it too, or leave it to a deeper node: followed to the letter, the algorithm loses texels. Here a quadrant
/// weighs all its texels, covered or not, and becomes an empty node, which passes the inherited value on,
/// where that serves as many of them as the best value of its own.
class TopDown {
  public:
    TopDown(ImageView<const DepthInterval> intervals, MultiresTree& tree)
        : intervals_(intervals), tree_(tree) {}

    void run() {
        std::vector<IntervalEnd> ends;
        for (int y = 0; y < intervals_.height; ++y) {
            for (int x = 0; x < intervals_.width; ++x) {
                const auto texel = static_cast<std::uint32_t>(y * intervals_.width + x);
                ends.push_back({intervals_(x, y).entry, false, texel});
                ends.push_back({intervals_(x, y).exit, true, texel});
            }
        }
        // Entries before exits at equal depth: intervals are closed, touching ones share their border.
        std::sort(ends.begin(), ends.end(), [](const IntervalEnd& p, const IntervalEnd& q) {
            if (p.depth != q.depth) return p.depth < q.depth;
            return p.exit != q.exit ? q.exit : p.texel < q.texel;
        });
        tree_.root_interval = most_stabbed(ends).interval;
        tree_.root.value = stored_depth(tree_.root_interval);
        add_children(tree_.root, tree_.root.value, ends, {0, 0, intervals_.width});
    }

  private:
    struct Square {
        int x, y, side;
    };
    struct Stabbed {
        DepthInterval interval;
        int count = 0;
    };

    DepthInterval interval_of(const IntervalEnd& end) const {
        const int texel = static_cast<int>(end.texel);
        return intervals_(texel % intervals_.width, texel / intervals_.width);
    }

    /// The depths stabbed most often: from the entry that reaches the greatest count to the next exit.
    static Stabbed most_stabbed(const std::vector<IntervalEnd>& ends) {
        Stabbed best;
        int open = 0;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            open += ends[i].exit ? -1 : 1;
            if (open > best.count) best = {{ends[i].depth, ends[i + 1].depth}, open};
        }
        return best;
    }

    /// Gives `node` children for the quadrants of `square` in which some texel cannot take `value`.
    void add_children(MultiresNode& node, float value, const std::vector<IntervalEnd>& ends, Square square) {
        const int half = square.side / 2;
        std::vector<IntervalEnd> quadrant[4];
        bool divided[4] = {};
        for (const IntervalEnd& end : ends) {
            const int texel = static_cast<int>(end.texel);
            const int q = (texel % intervals_.width >= square.x + half ? 1 : 0) +
                          (texel / intervals_.width >= square.y + half ? 2 : 0);
            quadrant[q].push_back(end);
            divided[q] = divided[q] || !contains(interval_of(end), value);
        }
        std::vector<MultiresNode> group;
        for (int q = 0; q < 4; ++q) {
            if (!divided[q]) continue;
            const Stabbed best = most_stabbed(quadrant[q]);
            int inherited = 0;
            for (const IntervalEnd& end : quadrant[q])
                inherited += !end.exit && contains(interval_of(end), value);
            const bool own = best.count > inherited;
            MultiresNode child;
            child.value = own ? stored_depth(best.interval) : 0.0f;
            add_children(child, own ? child.value : value, quadrant[q],
                         {square.x + (q % 2) * half, square.y + (q / 2) * half, half});
            const ChildKind kind =
                own ? (child.kinds == 0 ? ChildKind::leaf : ChildKind::full) : ChildKind::empty;
            node.kinds = (node.kinds | static_cast<std::uint32_t>(kind) << (2 * q)) & 0xffffu;
            group.push_back(child);
            quadrant[q] = {};
        }
        node.set_first_child(tree_.nodes.size());
        tree_.nodes.insert(tree_.nodes.end(), group.begin(), group.end());
    }

    ImageView<const DepthInterval> intervals_;
    MultiresTree& tree_;
};

}  // namespace

MultiresCounts count_nodes(const MultiresTree& tree) {
    MultiresCounts counts;
    (tree.root.kinds == 0 ? counts.leaf : counts.full) = 1;
    count(tree, tree.root, counts);
    return counts;
}

template <int dimensions>
typename MultiresBuilder<dimensions>::Part MultiresBuilder<dimensions>::join(const Part (&child)[children]) {
    DepthInterval intervals[children];
    for (int i = 0; i < children; ++i)
        intervals[i] = child[i].interval;
    const Combined combined = combine(intervals);

    Part part;
    part.interval = combined.interval;
    part.first_child = nodes.size();
    for (int i = 0; i < children; ++i) {
        const bool covered = (combined.covered >> i & 1u) != 0, inner = child[i].kinds != 0;
        if (covered && !inner) continue;
        const ChildKind kind = covered ? ChildKind::empty : (inner ? ChildKind::full : ChildKind::leaf);
        part.kinds |= static_cast<std::uint32_t>(kind) << (2 * i);
        nodes.push_back(
            {covered ? 0.0f : stored_depth(child[i].interval), child[i].kinds, child[i].first_child});
    }
    return part;
}

template <int dimensions>
std::uint64_t MultiresBuilder<dimensions>::append(const MultiresBuilder& other) {
    const std::uint64_t offset = nodes.size();
    nodes.reserve(nodes.size() + other.nodes.size());
    for (MultiresNode node : other.nodes) {
        node.set_first_child(node.first_child() + offset);
        nodes.push_back(node);
    }
    return offset;
}

template class MultiresBuilder<2>;
template class MultiresBuilder<3>;

MultiresTree build_bottom_up(ImageView<const DepthInterval> intervals) {
    MultiresTree tree;
    tree.levels = levels_of(intervals);
    Quadtree builder;
    const Quadtree::Part root = bottom_up(intervals, 0, 0, intervals.width, builder);
    tree.root = {stored_depth(root.interval), root.kinds, root.first_child};
    tree.root_interval = root.interval;
    tree.nodes = std::move(builder.nodes);
    return tree;
}

MultiresTree build_top_down(ImageView<const DepthInterval> intervals) {
    MultiresTree tree;
    tree.levels = levels_of(intervals);
    TopDown(intervals, tree).run();
    return tree;
}

float value_at(const MultiresTree& tree, std::uint32_t x, std::uint32_t y) {
    const MultiresNode* node = &tree.root;
    float value = node->value;
    for (int level = tree.levels - 1; level >= 0; --level) {
        const int child = static_cast<int>((x >> level & 1u) + 2 * (y >> level & 1u));
        const ChildKind kind = node->child(child);
        if (kind == ChildKind::none) break;
        // Children that exist stand together: count those before this one.
        std::uint64_t place = node->first_child();
        for (int i = 0; i < child; ++i)
            place += node->child(i) != ChildKind::none;
        node = &tree.nodes[place];
        if (kind != ChildKind::empty) value = node->value;
    }
    return value;
}

}  // namespace obscura
