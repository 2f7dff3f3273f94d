#include "hierarchy/multires.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

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

IntervalSource<2> source_of(ImageView<const DepthInterval> intervals) {
    return [intervals](const std::array<std::uint32_t, 2>& at) {
        return intervals(static_cast<int>(at[0]), static_cast<int>(at[1]));
    };
}

/// All intervals of 2^levels texels a side in Morton order: the texels of every square, or cube, of the tree
/// stand together, those of its children one after the other.
template <int dimensions>
std::vector<DepthInterval> in_morton_order(int levels, const IntervalSource<dimensions>& source) {
    CHECK(levels >= 0 && levels * dimensions < 40);
    std::vector<DepthInterval> all(std::size_t{1} << (levels * dimensions));
    for (std::size_t code = 0; code < all.size(); ++code) {
        std::array<std::uint32_t, dimensions> at{};
        for (int bit = 0; bit < levels * dimensions; ++bit)
            at[static_cast<std::size_t>(bit % dimensions)] |= static_cast<std::uint32_t>(code >> bit & 1u)
                                                              << (bit / dimensions);
        all[code] = source(at);
    }
    return all;
}

template <int dimensions>
typename MultiresBuilder<dimensions>::Part bottom_up(std::span<const DepthInterval> texels,
                                                     MultiresBuilder<dimensions>& builder) {
    using Builder = MultiresBuilder<dimensions>;
    if (texels.size() == 1) return Builder::texel(texels[0]);
    const std::size_t share = texels.size() / Builder::children;
    typename Builder::Part child[Builder::children];
    for (std::size_t i = 0; i < Builder::children; ++i)
        child[i] = bottom_up<dimensions>(texels.subspan(i * share, share), builder);
    return builder.join(child);
}

/// One end of a texel's interval, for the sweep.
struct IntervalEnd {
    float depth;
    bool exit;
    std::uint32_t texel;  ///< Morton code
};

/// Top-down construction with the ends of all intervals sorted once; children extract theirs in order.
///
/// The paper's algorithm 1 hands only the intervals that are still uncovered to a quadrant. But a texel that
/// an ancestor's value covers is decoded with the last value on its path, so a quadrant's own value must suit
/// it too, or leave it to a deeper node: followed to the letter, the algorithm loses texels. Here a quadrant
/// weighs all its texels, covered or not, and becomes an empty node, which passes the inherited value on,
/// where that serves as many of them as the best value of its own.
class TopDown {
  public:
    TopDown(std::span<const DepthInterval> texels, MultiresTree& tree) : texels_(texels), tree_(tree) {}

    void run() {
        std::vector<IntervalEnd> ends;
        for (std::uint32_t texel = 0; texel < texels_.size(); ++texel) {
            ends.push_back({texels_[texel].entry, false, texel});
            ends.push_back({texels_[texel].exit, true, texel});
        }
        // Entries before exits at equal depth: intervals are closed, touching ones share their border.
        std::sort(ends.begin(), ends.end(), [](const IntervalEnd& p, const IntervalEnd& q) {
            if (p.depth != q.depth) return p.depth < q.depth;
            return p.exit != q.exit ? q.exit : p.texel < q.texel;
        });
        tree_.root_interval = most_stabbed(ends).interval;
        tree_.root.value = stored_depth(tree_.root_interval);
        add_children(tree_.root, tree_.root.value, ends, tree_.levels);
    }

  private:
    struct Stabbed {
        DepthInterval interval;
        int count = 0;
    };

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

    /// Gives `node`, 2^height texels a side, children where some texel cannot take `value`.
    void add_children(MultiresNode& node, float value, const std::vector<IntervalEnd>& ends, int height) {
        if (height == 0) return;
        const std::uint32_t children = 1u << tree_.dimensions;
        const int shift = tree_.dimensions * (height - 1);
        std::vector<std::vector<IntervalEnd>> part(children);
        std::vector<char> divided(children, 0);
        for (const IntervalEnd& end : ends) {
            const std::uint32_t i = end.texel >> shift & (children - 1);
            part[i].push_back(end);
            divided[i] = divided[i] || !contains(texels_[end.texel], value);
        }
        std::vector<MultiresNode> group;
        std::uint32_t kinds = 0;
        for (std::uint32_t i = 0; i < children; ++i) {
            if (!divided[i]) continue;
            const Stabbed best = most_stabbed(part[i]);
            int inherited = 0;
            for (const IntervalEnd& end : part[i])
                inherited += !end.exit && contains(texels_[end.texel], value);
            const bool own = best.count > inherited;
            MultiresNode child;
            child.value = own ? stored_depth(best.interval) : 0.0f;
            add_children(child, own ? child.value : value, part[i], height - 1);
            const ChildKind kind =
                own ? (child.kinds == 0 ? ChildKind::leaf : ChildKind::full) : ChildKind::empty;
            kinds |= static_cast<std::uint32_t>(kind) << (2 * i);
            group.push_back(child);
            part[i] = {};
        }
        node = {node.value, kinds, tree_.nodes.size()};
        tree_.nodes.insert(tree_.nodes.end(), group.begin(), group.end());
    }

    std::span<const DepthInterval> texels_;
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
    DepthInterval of_children[children];
    for (int i = 0; i < children; ++i)
        of_children[i] = child[i].interval;
    const Combined combined = combine(of_children);

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
        if (keeps_intervals) intervals.push_back(covered ? DepthInterval{} : child[i].interval);
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
    intervals.insert(intervals.end(), other.intervals.begin(), other.intervals.end());
    return offset;
}

template <int dimensions>
void MultiresBuilder<dimensions>::drop(std::size_t mark) {
    nodes.resize(mark);
    if (keeps_intervals) intervals.resize(mark);
}

template <int dimensions>
void MultiresBuilder<dimensions>::assign(const MultiresBuilder& other) {
    nodes.assign(other.nodes.begin(), other.nodes.end());
    intervals.assign(other.intervals.begin(), other.intervals.end());
    keeps_intervals = other.keeps_intervals;
}

template class MultiresBuilder<2>;
template class MultiresBuilder<3>;

template <int dimensions>
MultiresTree build_bottom_up(int levels, const IntervalSource<dimensions>& source) {
    MultiresTree tree;
    tree.dimensions = dimensions;
    tree.levels = levels;
    MultiresBuilder<dimensions> builder;
    builder.keeps_intervals = true;
    const auto root = bottom_up<dimensions>(in_morton_order<dimensions>(levels, source), builder);
    tree.root = {stored_depth(root.interval), root.kinds, root.first_child};
    tree.root_interval = root.interval;
    tree.nodes = std::move(builder.nodes);
    tree.intervals = std::move(builder.intervals);
    return tree;
}
template MultiresTree build_bottom_up<2>(int, const IntervalSource<2>&);
template MultiresTree build_bottom_up<3>(int, const IntervalSource<3>&);

template <int dimensions>
MultiresTree build_top_down(int levels, const IntervalSource<dimensions>& source) {
    MultiresTree tree;
    tree.dimensions = dimensions;
    tree.levels = levels;
    TopDown(in_morton_order<dimensions>(levels, source), tree).run();
    return tree;
}
template MultiresTree build_top_down<2>(int, const IntervalSource<2>&);
template MultiresTree build_top_down<3>(int, const IntervalSource<3>&);

MultiresTree build_bottom_up(ImageView<const DepthInterval> intervals) {
    return build_bottom_up<2>(levels_of(intervals), source_of(intervals));
}

MultiresTree build_top_down(ImageView<const DepthInterval> intervals) {
    return build_top_down<2>(levels_of(intervals), source_of(intervals));
}

template <int dimensions>
float value_at(const MultiresTree& tree, const std::array<std::uint32_t, dimensions>& at) {
    CHECK(tree.dimensions == dimensions);
    const MultiresNode* node = &tree.root;
    float value = node->value;
    for (int level = tree.levels - 1; level >= 0; --level) {
        int child = 0;
        for (int d = 0; d < dimensions; ++d)
            child |= static_cast<int>(at[static_cast<std::size_t>(d)] >> level & 1u) << d;
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
template float value_at<2>(const MultiresTree&, const std::array<std::uint32_t, 2>&);
template float value_at<3>(const MultiresTree&, const std::array<std::uint32_t, 3>&);

float value_at(const MultiresTree& tree, std::uint32_t x, std::uint32_t y) {
    return value_at<2>(tree, {x, y});
}

}  // namespace obscura
