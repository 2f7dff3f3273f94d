#include "hierarchy/decode.h"

#include <algorithm>

#include "core/error.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

constexpr bool is_inner(std::uint32_t kind) {
    return kind >= static_cast<std::uint32_t>(ChildKind::empty);
}

constexpr bool has_value(std::uint32_t kind) {
    return (kind & 1u) != 0;
}

/// Where a descent stands.
struct Step {
    bool inner = true;  ///< at an inner node, `node`; else the descent is over
    std::uint64_t node = 0;
    std::uint64_t value = 0;  ///< unit of the last value met
};

Step at_root(const TreeCode& code) {
    return {true, 0, header_units(code.layout)};
}

/// Child i of an inner node of this height.
Step step_down(const TreeCode& code, Step step, int height, int i) {
    const TreeHeader header = header_at(code, step.node);
    const std::uint32_t kind = kind_of(header.kinds, i);
    if (kind == 0) return {false, 0, step.value};
    const std::uint64_t child = children_of(code, step.node, height, header) +
                                units_before(units_of_kinds(code.layout), header.kinds, i);
    if (!is_inner(kind)) return {false, 0, child};
    return {true, child, has_value(kind) ? child + header_units(code.layout) : step.value};
}

/// From a node of height `from` towards texel (x, y), to height `to`.
Step descend(const TreeCode& code, Step step, int from, int to, std::uint32_t x, std::uint32_t y) {
    for (int height = from; height > to && step.inner; --height) {
        const int bit = height - 1;
        step = step_down(code, step, height, static_cast<int>((x >> bit & 1u) + 2 * (y >> bit & 1u)));
    }
    return step;
}

/// Entries of the square of 2^(k - depth) entries that a node at this depth covers.
void fill_top(const TreeCode& code, Step step, int depth, std::uint32_t x, std::uint32_t y, int k,
              std::vector<TopNode>& grid) {
    const std::uint32_t side = 1u << (k - depth);
    if (!step.inner || depth == k) {
        const TopNode entry{step.inner ? static_cast<std::uint32_t>(step.node) : no_tree_node,
                            static_cast<std::uint32_t>(step.value)};
        for (std::uint32_t row = y; row < y + side; ++row)
            std::fill_n(grid.begin() + (static_cast<std::ptrdiff_t>(row) << k) + x, side, entry);
        return;
    }
    for (int i = 0; i < 4; ++i) {
        const std::uint32_t right = i % 2 != 0 ? side / 2 : 0, down = i / 2 != 0 ? side / 2 : 0;
        fill_top(code, step_down(code, step, code.levels - depth, i), depth + 1, x + right, y + down, k,
                 grid);
    }
}

/// Appends what hangs below a node, children before parents; returns the node without its value.
MultiresNode decode_below(const TreeCode& code, std::uint64_t node, int height, MultiresTree& tree) {
    const TreeHeader header = header_at(code, node);
    const KindUnits units = units_of_kinds(code.layout);
    std::uint64_t unit = children_of(code, node, height, header);
    MultiresNode group[4];
    int count = 0;
    for (int i = 0; i < 4; ++i) {
        const std::uint32_t kind = kind_of(header.kinds, i);
        if (kind == 0) continue;
        MultiresNode& child = group[count++];
        if (is_inner(kind)) child = decode_below(code, unit, height - 1, tree);
        if (has_value(kind))
            child.value = depth_at(code, is_inner(kind) ? unit + header_units(code.layout) : unit);
        unit += units[kind];
    }
    MultiresNode result;
    result.kinds = header.kinds & 0xffffu;
    result.set_first_child(tree.nodes.size());
    tree.nodes.insert(tree.nodes.end(), group, group + count);
    return result;
}

}  // namespace

float tree_value_at_level(const TreeCode& code, std::uint32_t x, std::uint32_t y, int level) {
    return depth_at(code, descend(code, at_root(code), code.levels, level, x, y).value);
}

float tree_value(const TreeCode& code, std::uint32_t x, std::uint32_t y) {
    return tree_value_at_level(code, x, y, 0);
}

float tree_value_from_top(const TreeCode& code, std::uint32_t x, std::uint32_t y) {
    CHECK(code.top != nullptr);
    const int height = code.levels - code.top_levels;
    const TopNode& top = code.top[(static_cast<std::size_t>(y >> height) << code.top_levels) + (x >> height)];
    const Step start{top.node != no_tree_node, top.node, top.value};
    return depth_at(code, descend(code, start, height, 0, x, y).value);
}

void set_top_grid(ShadowTree& tree, int top_levels) {
    CHECK(top_levels >= 0 && top_levels <= std::min<int>(tree.code.levels, max_top_levels));
    tree.top = nullptr;
    tree.code.top = nullptr;
    tree.code.top_levels = 0;
    if (top_levels == 0) return;
    auto grid = std::make_shared<std::vector<TopNode>>(std::size_t{1} << (2 * top_levels));
    fill_top(tree.code, at_root(tree.code), 0, 0, 0, top_levels, *grid);
    tree.code.top = grid->data();
    tree.code.top_levels = top_levels;
    tree.top = std::move(grid);
}

MultiresTree decode_tree(const ShadowTree& shadow_tree) {
    const TreeCode& code = shadow_tree.code;
    MultiresTree tree;
    tree.levels = code.levels;
    tree.root = decode_below(code, 0, code.levels, tree);
    tree.root.value = depth_at(code, header_units(code.layout));
    tree.root_interval = {tree.root.value, tree.root.value};
    return tree;
}

}  // namespace obscura
