#include "hierarchy/certain_tree.h"

#include <utility>

#include "core/error.h"

namespace obscura {
namespace {

using Depths = MultiresBuilder<2>;

/// Where there are common depths, the bottom-up construction has nothing below.
Depths::Part depths_of(const CertainTree& tree, CertainSquare square, Depths& builder) {
    const DepthInterval common = tree.common(square);
    if (has_depth(common)) return Depths::texel(common);
    Depths::Part child[4];
    for (int i = 0; i < 4; ++i)
        child[i] = depths_of(tree, tree.quadrant(square, i), builder);
    return builder.join(child);
}

void check_groups(std::uint64_t count) {
    if (count > UINT32_MAX) throw LimitError("a shadow map has more squares than 32 bits can number");
}

}  // namespace

CertainSquare add_certain(const CertainSquare (&quadrant)[4], DepthInterval common,
                          std::vector<CertainGroup>& groups) {
    const CertainSquare& first = quadrant[0];
    if (!first.is_group() && first == quadrant[1] && first == quadrant[2] && first == quadrant[3])
        return first;
    check_groups(groups.size() + 1);
    groups.push_back({{quadrant[0], quadrant[1], quadrant[2], quadrant[3]}, common});
    return CertainSquare::of_group(static_cast<std::uint32_t>(groups.size() - 1));
}

CertainBuilder::Part CertainBuilder::join(const Part (&child)[4]) {
    CertainSquare quadrant[4];
    DepthInterval common = child[0].interval;
    for (int i = 0; i < 4; ++i) {
        quadrant[i] = child[i].square();
        common = common_depths(common, child[i].interval);
    }
    const CertainSquare square = add_certain(quadrant, common, nodes);
    if (!square.is_group()) return texel(common);
    return {common, 1, square.group()};
}

std::uint64_t CertainBuilder::append(const CertainBuilder& other) {
    const std::uint64_t offset = nodes.size();
    check_groups(offset + other.nodes.size());
    nodes.reserve(nodes.size() + other.nodes.size());
    for (CertainGroup group : other.nodes) {
        for (CertainSquare& square : group.quadrant) {
            if (square.is_group())
                square = CertainSquare::of_group(square.group() + static_cast<std::uint32_t>(offset));
        }
        nodes.push_back(group);
    }
    return offset;
}

MultiresTree multires_of(const CertainTree& certain) {
    MultiresTree tree;
    tree.levels = certain.levels;
    Depths builder;
    const Depths::Part root = depths_of(certain, certain.root, builder);
    tree.root = {stored_depth(root.interval), root.kinds, root.first_child};
    tree.root_interval = root.interval;
    tree.nodes = std::move(builder.nodes);
    return tree;
}

}  // namespace obscura
