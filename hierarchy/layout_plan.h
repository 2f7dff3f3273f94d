#pragma once
// Where the nodes of a serialised tree go: sizes, scales of offsets and padding, before a bit is written.
//
// S. Lefebvre, H. Hoppe, "Compressed Random-Access Trees for Spatially Coherent Data", EGSR 2007, section 4.
// A node's block is the group of its children followed by the blocks of these, each at a distance from its
// own node that is a multiple of the scale of that node's height:
//
//   | child 0 | child 1 | child 2 | child 3 |pad| block of one |pad| block of another | ...
//
// Distances within a block depend on scales of lesser heights only, so scales are found from the texels up.
// Unlike the paper, blocks stand smallest first: offsets have to span what lies before, and the largest block
// is the one not to span.

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "hierarchy/multires.h"
#include "hierarchy/tree_code.h"
#include "hierarchy/tree_units.h"

namespace obscura {

/// The kinds of a node's four or eight children, two bits each.
template <int children>
using KindWord = std::conditional_t<children == 4, std::uint8_t, std::uint16_t>;

/// The kinds of a tree, without values. kinds[h] has one word for each inner node of height h, left to right,
/// so that the inner children of consecutive nodes are consecutive one height below. The root counts as an
/// inner node, and above it stands a parent whose one child it is.
template <int children>
// NOLINTNEXTLINE(bugprone-reserved-identifier): of copies of its arrays, which the compiler names
struct TreeShapeOf {
    int levels = 0;
    std::vector<KindWord<children>> kinds[max_tree_levels + 2];
    MultiresCounts counts;  ///< as count_nodes()
};
using TreeShape = TreeShapeOf<4>;

/// `tree` has as many children to a node.
template <int children>
TreeShapeOf<children> shape_of(const MultiresTree& tree);

/// The children of one node, seen from their group: those with blocks of their own, in the
/// order of these.
template <int children>
struct FamilyOf {
    struct Member {
        int child = 0;
        std::uint32_t unit = 0;   ///< of the child, in the group
        std::uint32_t block = 0;  ///< units of the child's block
    };
    std::uint32_t group_units = 0;
    int inner = 0;  ///< children that are inner nodes, with blocks or without
    int count = 0;
    Member member[children];
};
using Family = FamilyOf<4>;

/// In which order siblings' blocks stand. Smallest first, offsets span least. In child order the tree stands
/// depth-first, and what is behind in one is behind in the other.
enum class BlockOrder { smallest_first, child };

/// `blocks`: units of the blocks of the inner children, in child order.
template <int children>
FamilyOf<children> family_of(const KindUnits& units, std::uint32_t kinds, const std::uint32_t* blocks,
                             BlockOrder order = BlockOrder::smallest_first);

/// Where the blocks of a family begin, in units from the group's first.
struct Placement {
    std::uint64_t start[8] = {};  ///< by place in FamilyOf::member
    std::uint64_t end = 0;        ///< behind the last block: units of the parent's block
    std::uint64_t reach = 0;      ///< longest distance from a child to its block
};

template <int children>
Placement place(const FamilyOf<children>& family, std::uint32_t scale);

/// How far offsets go and what they cost at one height.
struct ScaleChoice {
    std::uint32_t scale = 1;
    std::uint64_t padding = 0;  ///< units
};

/// The scale of the children's height that wastes fewest units, the smallest of several, among all with which
/// every offset is at most `max_offset` (>= 15): found exhaustively. `parents` are kinds of nodes, `blocks`
/// the units of their inner children's blocks.
template <int children>
ScaleChoice best_scale(const KindUnits& units, std::span<const KindWord<children>> parents,
                       std::span<const std::uint32_t> blocks, std::uint32_t max_offset,
                       BlockOrder order = BlockOrder::smallest_first);

// NOLINTNEXTLINE(bugprone-reserved-identifier): of copies of its arrays, which the compiler names
struct LayoutPlan {
    std::uint32_t scale[max_tree_levels + 1] = {};
    std::vector<std::uint32_t> blocks[max_tree_levels + 2];  ///< units, for each byte of TreeShape::kinds
    std::uint64_t units = 0;                                 ///< of the tree, padding included
    std::uint64_t padding = 0;                               ///< units
    bool fits = true;  ///< units are at most max_units; else the rest has no meaning
};

/// O(inner nodes) time and memory, apart from the search at heights whose blocks offsets cannot span. For 4
/// and 8 children, like everything here.
template <int children>
LayoutPlan plan_layout(const TreeShapeOf<children>& shape, const KindUnits& units, std::uint32_t max_offset,
                       std::uint64_t max_units = max_tree_units,
                       BlockOrder order = BlockOrder::smallest_first);

}  // namespace obscura
