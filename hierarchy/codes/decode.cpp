#include "hierarchy/codes/decode.h"

#include <algorithm>

#include "core/error.h"
#include "hierarchy/codes/tree_step.h"

namespace obscura {
namespace {

/// From a node of height `from` towards texel (x, y), to height `to`.
template <class Code>
TreePlace descend(const TreeCode& tree, TreePlace place, int from, int to, std::uint32_t x, std::uint32_t y) {
    for (int height = from; height > to && place.node != no_tree_node; --height)
        place = Code::child(tree, place, height, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y));
    return place;
}

/// Entries of the square of 2^(k - depth) entries that a node at this depth covers.
template <class Code>
void fill_top(const TreeCode& tree, TreePlace place, int depth, std::uint32_t x, std::uint32_t y, int k,
              std::vector<TopNode>& grid) {
    const std::uint32_t side = 1u << (k - depth);
    if (place.node == no_tree_node || depth == k) {
        for (std::uint32_t row = y; row < y + side; ++row) {
            TopNode* entry = grid.data() + ((static_cast<std::size_t>(row) << k) + x) *
                                               static_cast<std::size_t>(top_nodes_of(tree.code));
            for (std::uint32_t i = 0; i < side; ++i) {
                *entry++ = {place.node, place.value};
                if constexpr (Code::counts_values) *entry++ = {place.count, place.inside};
            }
        }
        return;
    }
    const int height = tree.levels - depth, texels = tree.levels - k;
    for (int i = 0; i < 4; ++i) {
        const std::uint32_t cx = x + (i % 2 != 0 ? side / 2 : 0), cy = y + (i / 2 != 0 ? side / 2 : 0);
        const TreePlace child = Code::child(tree, place, height, static_cast<std::int32_t>(cx << texels),
                                            static_cast<std::int32_t>(cy << texels));
        fill_top<Code>(tree, child, depth + 1, cx, cy, k, grid);
    }
}

}  // namespace

float tree_value_at_level(const TreeCode& tree, std::uint32_t x, std::uint32_t y, int level) {
    return with_code(tree, [&]<class Code>(Code) {
        return depth_of<Code>(tree, descend<Code>(tree, Code::root(tree), tree.levels, level, x, y),
                              static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), level);
    });
}

float tree_value(const TreeCode& tree, std::uint32_t x, std::uint32_t y) {
    return tree_value_at_level(tree, x, y, 0);
}

float tree_value_from_top(const TreeCode& tree, std::uint32_t x, std::uint32_t y) {
    CHECK(tree.top != nullptr);
    const int height = tree.levels - tree.top_levels;
    const std::size_t entry = (static_cast<std::size_t>(y >> height) << tree.top_levels) + (x >> height);
    const TopNode* top = tree.top + entry * static_cast<std::size_t>(top_nodes_of(tree.code));
    return with_code(tree, [&]<class Code>(Code) {
        TreePlace place{top[0].node, top[0].value, 0, 0};
        if constexpr (Code::counts_values) {
            place.count = top[1].node;
            place.inside = top[1].value;
        }
        return depth_of<Code>(tree, descend<Code>(tree, place, height, 0, x, y), static_cast<std::int32_t>(x),
                              static_cast<std::int32_t>(y), 0);
    });
}

void set_top_grid(ShadowTree& tree, int top_levels) {
    CHECK(top_levels >= 0 && top_levels <= std::min<int>(tree.code.levels, max_top_levels));
    tree.top = nullptr;
    tree.code.top = nullptr;
    tree.code.top_levels = 0;
    if (top_levels == 0) return;
    auto grid = std::make_shared<std::vector<TopNode>>(
        static_cast<std::size_t>(top_nodes_of(tree.code.code)) * (std::size_t{1} << (2 * top_levels)));
    with_code(tree.code, [&]<class Code>(Code) {
        fill_top<Code>(tree.code, Code::root(tree.code), 0, 0, 0, top_levels, *grid);
    });
    tree.code.top = grid->data();
    tree.code.top_levels = top_levels;
    tree.top = std::move(grid);
}

}  // namespace obscura
