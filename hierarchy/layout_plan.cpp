#include "hierarchy/layout_plan.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace obscura {
namespace {

constexpr std::uint32_t empty_kind = static_cast<std::uint32_t>(ChildKind::empty);
constexpr std::uint32_t leaf_kind = static_cast<std::uint32_t>(ChildKind::leaf);
constexpr std::uint32_t full_kind = static_cast<std::uint32_t>(ChildKind::full);

constexpr bool is_inner(std::uint32_t kind) {
    return kind >= empty_kind;
}

/// Recursion is as deep as the tree is high: 20 at most.
template <int children>
void collect(const MultiresTree& tree, const MultiresNode& node, int height, TreeShapeOf<children>& shape) {
    CHECK(height > 0 || node.kinds == 0, "texels have no children");
    shape.kinds[height].push_back(static_cast<KindWord<children>>(node.kinds));
    // Only roots have no children here; what stands in first_child then means nothing.
    if (node.kinds == 0) return;
    const MultiresNode* child = tree.nodes.data() + node.first_child();
    for (int i = 0; i < children; ++i) {
        const std::uint32_t kind = kind_of(node.kinds, i);
        shape.counts.leaf += kind == leaf_kind;
        shape.counts.empty += kind == empty_kind;
        shape.counts.full += kind == full_kind;
        if (is_inner(kind)) collect(tree, *child, height - 1, shape);
        child += kind != 0;
    }
}

constexpr std::uint64_t round_up(std::uint64_t distance, std::uint32_t scale) {
    return scale == 1 ? distance : (distance + scale - 1) / scale * scale;
}

/// Units that are no node's, in the parent's block but not in the children's.
template <int children>
std::uint64_t padding_of(const FamilyOf<children>& family, const Placement& placement) {
    std::uint64_t used = family.group_units;
    for (int m = 0; m < family.count; ++m)
        used += family.member[m].block;
    return placement.end - used;
}

/// Distance from the first child with a block to that block, before rounding up.
template <int children>
std::int64_t first_distance(const FamilyOf<children>& family) {
    return family.group_units - family.member[0].unit;
}

/// Padding of all families with one scale; nothing when an offset does not reach or `limit` is met.
///
/// The first block of a family follows its group, which is a few units long, so that a scale s costs at least
/// s - first_distance there: `least` is the sum of that, known without looking. Families add what they waste
/// beyond it.
template <int children>
bool padding_below(const std::vector<FamilyOf<children>>& families, std::uint32_t scale,
                   std::uint32_t max_offset, std::int64_t least, std::int64_t limit, std::int64_t& padding) {
    padding = least;
    for (const FamilyOf<children>& family : families) {
        const Placement placement = place(family, scale);
        if (placement.reach > std::uint64_t{max_offset} * scale) return false;
        padding += static_cast<std::int64_t>(padding_of(family, placement)) -
                   (std::int64_t{scale} - first_distance(family));
        if (padding >= limit) return false;
    }
    return true;
}

/// All scales from the least that can reach, up to where `least` alone exceeds the best found. There is
/// always a best: one rounding per child lengthens a distance d to less than d + 4s (8s), so every s >= d /
/// (max_offset - 4 (8)) serves.
template <int children>
ScaleChoice search(const std::vector<FamilyOf<children>>& families, std::uint64_t reach,
                   std::uint32_t max_offset) {
    std::int64_t firsts = 0;
    for (const FamilyOf<children>& family : families)
        firsts += first_distance(family);
    const auto count = static_cast<std::int64_t>(families.size());

    ScaleChoice best;
    std::int64_t best_padding = std::numeric_limits<std::int64_t>::max();
    for (auto scale = static_cast<std::uint32_t>((reach + max_offset - 1) / max_offset);; ++scale) {
        const std::int64_t least = count * scale - firsts;
        if (least >= best_padding) break;
        std::int64_t padding;
        if (!padding_below(families, scale, max_offset, least, best_padding, padding)) continue;
        best_padding = padding;
        best = {scale, static_cast<std::uint64_t>(padding)};
    }
    return best;
}

/// Calls visit(family) for each node of `parents`.
template <int children, class Visit>
void for_each_family(const KindUnits& units, std::span<const KindWord<children>> parents,
                     std::span<const std::uint32_t> blocks, BlockOrder order, const Visit& visit) {
    const std::uint32_t* next = blocks.data();
    for (const KindWord<children> kinds : parents) {
        const FamilyOf<children> family = family_of<children>(units, kinds, next, order);
        next += family.inner;
        visit(family);
    }
}

}  // namespace

template <int children>
TreeShapeOf<children> shape_of(const MultiresTree& tree) {
    CHECK(1 << tree.dimensions == children && tree.levels >= 0 && tree.levels <= max_tree_levels);
    TreeShapeOf<children> shape;
    shape.levels = tree.levels;
    (tree.root.kinds == 0 ? shape.counts.leaf : shape.counts.full) = 1;
    collect(tree, tree.root, tree.levels, shape);
    // The root is stored as a full node, with children or without.
    shape.kinds[tree.levels + 1].push_back(full_kind);
    return shape;
}

template <int children>
FamilyOf<children> family_of(const KindUnits& units, std::uint32_t kinds, const std::uint32_t* blocks,
                             BlockOrder order) {
    FamilyOf<children> family;
    for (int i = 0; i < children; ++i) {
        const std::uint32_t kind = kind_of(kinds, i);
        if (is_inner(kind)) {
            const typename FamilyOf<children>::Member member{i, family.group_units, blocks[family.inner++]};
            if (member.block > 0) {
                int m = family.count++;
                for (; order == BlockOrder::smallest_first && m > 0 &&
                       family.member[m - 1].block > member.block;
                     --m)
                    family.member[m] = family.member[m - 1];
                family.member[m] = member;
            }
        }
        family.group_units += units[kind];
    }
    return family;
}

template <int children>
Placement place(const FamilyOf<children>& family, std::uint32_t scale) {
    Placement placement;
    placement.end = family.group_units;
    for (int m = 0; m < family.count; ++m) {
        const typename FamilyOf<children>::Member& member = family.member[m];
        const std::uint64_t distance = round_up(placement.end - member.unit, scale);
        placement.reach = std::max(placement.reach, distance);
        placement.start[m] = member.unit + distance;
        placement.end = placement.start[m] + member.block;
    }
    return placement;
}

template <int children>
ScaleChoice best_scale(const KindUnits& units, std::span<const KindWord<children>> parents,
                       std::span<const std::uint32_t> blocks, std::uint32_t max_offset, BlockOrder order) {
    CHECK(max_offset >= 15);
    std::uint64_t reach = 0;
    for_each_family<children>(units, parents, blocks, order, [&](const FamilyOf<children>& family) {
        reach = std::max(reach, place(family, 1).reach);
    });
    if (reach <= max_offset) return {};

    std::vector<FamilyOf<children>> families;
    for_each_family<children>(units, parents, blocks, order, [&](const FamilyOf<children>& family) {
        if (family.count > 0) families.push_back(family);
    });
    return search(families, reach, max_offset);
}

template <int children>
LayoutPlan plan_layout(const TreeShapeOf<children>& shape, const KindUnits& units, std::uint32_t max_offset,
                       std::uint64_t max_units, BlockOrder order) {
    CHECK(max_units <= max_tree_units);
    LayoutPlan plan;
    plan.blocks[0].assign(shape.kinds[0].size(), 0);
    for (int height = 0; height <= shape.levels; ++height) {
        const std::vector<KindWord<children>>& parents = shape.kinds[height + 1];
        const ScaleChoice choice =
            best_scale<children>(units, parents, plan.blocks[height], max_offset, order);
        plan.scale[height] = choice.scale;
        plan.padding += choice.padding;
        plan.blocks[height + 1].reserve(parents.size());
        for_each_family<children>(units, parents, plan.blocks[height], order,
                                  [&](const FamilyOf<children>& family) {
                                      const std::uint64_t end = place(family, choice.scale).end;
                                      plan.fits = plan.fits && end <= max_units;
                                      plan.blocks[height + 1].push_back(static_cast<std::uint32_t>(end));
                                  });
        if (!plan.fits) return plan;
    }
    plan.units = plan.blocks[shape.levels + 1].front();
    return plan;
}

template TreeShapeOf<4> shape_of<4>(const MultiresTree&);
template FamilyOf<4> family_of<4>(const KindUnits&, std::uint32_t, const std::uint32_t*, BlockOrder);
template Placement place<4>(const FamilyOf<4>&, std::uint32_t);
template ScaleChoice best_scale<4>(const KindUnits&, std::span<const KindWord<4>>,
                                   std::span<const std::uint32_t>, std::uint32_t, BlockOrder);
template LayoutPlan plan_layout<4>(const TreeShapeOf<4>&, const KindUnits&, std::uint32_t, std::uint64_t,
                                   BlockOrder);
template TreeShapeOf<8> shape_of<8>(const MultiresTree&);
template FamilyOf<8> family_of<8>(const KindUnits&, std::uint32_t, const std::uint32_t*, BlockOrder);
template Placement place<8>(const FamilyOf<8>&, std::uint32_t);
template ScaleChoice best_scale<8>(const KindUnits&, std::span<const KindWord<8>>,
                                   std::span<const std::uint32_t>, std::uint32_t, BlockOrder);
template LayoutPlan plan_layout<8>(const TreeShapeOf<8>&, const KindUnits&, std::uint32_t, std::uint64_t,
                                   BlockOrder);

}  // namespace obscura
