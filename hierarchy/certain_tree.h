#pragma once
// What a light view knows of its squares before any depth is chosen: for each the depths that all its texels
// have in common, or that they have none.
//
// The multiresolution tree of one map (hierarchy/multires.h) follows from it, and so does every tree over
// several maps: the common depths of a square in two maps are what is common to both. Trees over stacks are
// made from these, map after map, without a texel being looked at again (hierarchy/stack). For that a square
// with common depths needs its quadrants too, where theirs are more: another map may leave the square none,
// and the quadrants some.

#include <bit>
#include <cstdint>
#include <vector>

#include "core/types.h"
#include "hierarchy/multires.h"

namespace obscura {

/// No depth in common.
constexpr DepthInterval no_common_depth{1.0f, 0.0f};
constexpr bool has_depth(DepthInterval i) {
    return i.entry <= i.exit;
}
constexpr DepthInterval common_depths(DepthInterval a, DepthInterval b) {
    const DepthInterval both{a.entry > b.entry ? a.entry : b.entry, a.exit < b.exit ? a.exit : b.exit};
    return has_depth(both) ? both : no_common_depth;
}

/// A square: uniform, all its texels can take these depths and no others; or a group, which has its
/// quadrants.
class CertainSquare {
  public:
    CertainSquare() : CertainSquare(DepthInterval{}) {}
    /// Uniform.
    explicit CertainSquare(DepthInterval depths)
        : entry_(depths.entry), rest_(std::bit_cast<std::uint32_t>(depths.exit)) {}
    static CertainSquare of_group(std::uint32_t group) {
        CertainSquare square;
        square.entry_ = no_depth;
        square.rest_ = group;
        return square;
    }
    bool is_group() const { return entry_ == no_depth; }
    DepthInterval depths() const { return {entry_, std::bit_cast<float>(rest_)}; }
    std::uint32_t group() const { return rest_; }
    friend bool operator==(const CertainSquare&, const CertainSquare&) = default;

  private:
    static constexpr float no_depth = 2.0f;
    float entry_;
    std::uint32_t rest_;
};
static_assert(sizeof(CertainSquare) == 8);

/// Quadrants in the order of a quadtree, x + 2 y, and what they have in common.
struct CertainGroup {
    CertainSquare quadrant[4];
    DepthInterval common;
};

/// A map of 2^levels texels a side.
struct CertainTree {
    int levels = 0;
    CertainSquare root;
    std::vector<CertainGroup> groups;  ///< in the order they were finished

    DepthInterval common(CertainSquare s) const {
        return s.is_group() ? groups[s.group()].common : s.depths();
    }
    /// Quadrant i: all of a uniform square is like it.
    CertainSquare quadrant(CertainSquare s, int i) const {
        return s.is_group() ? groups[s.group()].quadrant[i] : s;
    }
    std::uint64_t bytes() const { return groups.size() * sizeof(CertainGroup); }
};

/// A square of these quadrants, appended to `groups` unless it is uniform. LimitError beyond 2^32 groups.
CertainSquare add_certain(const CertainSquare (&quadrant)[4], DepthInterval common,
                          std::vector<CertainGroup>& groups);

/// Collects such a tree from its finished parts: what MultiresBuilder<2> is for trees of depths, with names
/// to match.
class CertainBuilder {
  public:
    static constexpr bool keeps_detail = true;

    struct Part {
        DepthInterval interval;         ///< common depths
        std::uint32_t kinds = 0;        ///< 0: uniform
        std::uint64_t first_child = 0;  ///< else its group
        CertainSquare square() const {
            return kinds == 0 ? CertainSquare(interval)
                              : CertainSquare::of_group(static_cast<std::uint32_t>(first_child));
        }
    };

    static Part texel(DepthInterval interval) { return {interval, 0, 0}; }
    /// Quadrants to their square.
    Part join(const Part (&child)[4]);
    /// Appends another builder's groups; returns what to add to its parts' first_child.
    std::uint64_t append(const CertainBuilder& other);
    void drop(std::size_t mark) { nodes.resize(mark); }
    void assign(const CertainBuilder& other) { nodes.assign(other.nodes.begin(), other.nodes.end()); }

    std::vector<CertainGroup> nodes;
};

/// The tree of depths that follows: that of build_bottom_up() over the intervals.
MultiresTree multires_of(const CertainTree& tree);

}  // namespace obscura
