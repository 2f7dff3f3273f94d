#pragma once
// The multiresolution hierarchy (MH): a sparse tree of depths, one value per node, in which every texel finds
// a depth of its own interval by going down as far as the tree goes and taking the last value met.
//
// Scandolo, Bauszat, Eisemann 2016, section 3. Works for quadtrees (2^2 children) and octrees (2^3).

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/image.h"
#include "core/types.h"

namespace obscura {

/// What stands in a child's place. The numbers are those of the serialised tree (paper, section 3.2).
enum class ChildKind : std::uint32_t {
    none = 0,   ///< the parent's value holds
    leaf = 1,   ///< a value, no children
    empty = 2,  ///< no value of its own, children
    full = 3,   ///< a value and children
};

/// A node of the tree under construction; its children that exist stand together, in child order.
/// Twelve bytes: there are tens of millions.
struct MultiresNode {
    float value = 0;               ///< leaf and full: the stored depth
    std::uint32_t kinds : 16 = 0;  ///< two bits per child
    std::uint32_t first_high : 16 = 0;
    std::uint32_t first_low = 0;

    MultiresNode() = default;
    MultiresNode(float value_, std::uint32_t kinds_, std::uint64_t first_child_)
        : value(value_), kinds(kinds_ & 0xffffu) {
        set_first_child(first_child_);
    }
    ChildKind child(int i) const { return static_cast<ChildKind>(kinds >> (2 * i) & 3u); }
    /// Index into MultiresTree::nodes, below 2^48.
    std::uint64_t first_child() const { return std::uint64_t{first_high} << 32 | first_low; }
    void set_first_child(std::uint64_t index) {
        first_high = static_cast<std::uint32_t>(index >> 32) & 0xffffu;
        first_low = static_cast<std::uint32_t>(index);
    }
};
static_assert(sizeof(MultiresNode) == 12);

/// Numbers that papers compare.
struct MultiresCounts {
    std::uint64_t full = 0, empty = 0, leaf = 0;
    friend bool operator==(const MultiresCounts&, const MultiresCounts&) = default;
};

/// A tree over 2^levels texels a side in `dimensions` dimensions. The root always has a value.
struct MultiresTree {
    int dimensions = 2;
    int levels = 0;  ///< depth of the texels below the root
    MultiresNode root;
    DepthInterval root_interval;
    std::vector<MultiresNode> nodes;  ///< groups of siblings, in the order they were finished
    /// Of each node: the depths that its value may be. Codes that choose values themselves ask for them.
    /// Empty where they were not kept; empty nodes have that of the background.
    std::vector<DepthInterval> intervals;
};

MultiresCounts count_nodes(const MultiresTree& tree);

/// Collects a tree from its finished parts, children before parents. One of these per task; parts are merged
/// in the order of their place in the tree, so the result does not depend on how the work was cut.
template <int dimensions>
class MultiresBuilder {
  public:
    static constexpr int children = 1 << dimensions;
    static constexpr bool keeps_detail = false;  ///< nothing below squares that have a depth in common

    /// A finished part of the tree: its interval and its root, whose value is set by the parent.
    struct Part {
        DepthInterval interval;
        std::uint32_t kinds = 0;
        std::uint64_t first_child = 0;
    };

    static Part texel(DepthInterval interval) { return {interval, 0, 0}; }

    /// The combine step: siblings to their parent. Children that the parent's value covers disappear, or stay
    /// as empty nodes if something hangs below them; the others get a value of their own.
    Part join(const Part (&child)[children]);

    /// Appends another builder's nodes; returns what to add to its parts' first_child.
    std::uint64_t append(const MultiresBuilder& other);
    /// Drops the nodes from `mark` on.
    void drop(std::size_t mark);
    /// Takes over a copy of another builder's nodes that is as large as it must be.
    void assign(const MultiresBuilder& other);

    std::vector<MultiresNode> nodes;
    std::vector<DepthInterval> intervals;  ///< of the nodes, if kept
    bool keeps_intervals = false;
};

extern template class MultiresBuilder<2>;
extern template class MultiresBuilder<3>;

/// Where intervals come from: that of the texel at x, y (and in stacks of maps the number of the map).
template <int dimensions>
using IntervalSource = std::function<DepthInterval(const std::array<std::uint32_t, dimensions>&)>;

/// Bottom-up construction over 2^levels texels a side: the definition that the construction from triangles
/// must equal. O(n) time and memory for n texels. For 2 and 3 dimensions.
template <int dimensions>
MultiresTree build_bottom_up(int levels, const IntervalSource<dimensions>& source);

/// Top-down construction (paper, algorithm 1, made lossless: see multires.cpp): each node takes the depth
/// that most texels of its square can take. O(n log n); for comparison. For 2 and 3 dimensions.
template <int dimensions>
MultiresTree build_top_down(int levels, const IntervalSource<dimensions>& source);

/// The same of a square power-of-two picture of intervals.
MultiresTree build_bottom_up(ImageView<const DepthInterval> intervals);
MultiresTree build_top_down(ImageView<const DepthInterval> intervals);

/// Value of a texel by plain descent: the oracle of every faster lookup.
template <int dimensions>
float value_at(const MultiresTree& tree, const std::array<std::uint32_t, dimensions>& at);
float value_at(const MultiresTree& tree, std::uint32_t x, std::uint32_t y);

}  // namespace obscura
