// The tree that was encoded, read back plainly.

#include <fmt/format.h>

#include "hierarchy/mh/mh.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

constexpr bool is_inner(std::uint32_t kind) {
    return kind >= static_cast<std::uint32_t>(ChildKind::empty);
}

constexpr bool has_value(std::uint32_t kind) {
    return (kind & 1u) != 0;
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

MultiresTree decode_mh(const ShadowTree& shadow_tree) {
    const TreeCode& code = shadow_tree.code;
    MultiresTree tree;
    tree.levels = code.levels;
    tree.root = decode_below(code, 0, code.levels, tree);
    tree.root.value = depth_at(code, header_units(code.layout));
    tree.root_interval = {tree.root.value, tree.root.value};
    return tree;
}

std::string mh_text(const ShadowTree& tree) {
    const double padding =
        tree.bytes == 0 ? 0.0 : static_cast<double>(tree.padding_bytes) / static_cast<double>(tree.bytes);
    return fmt::format("{}, padding {:.2f} %", row_of(tree.code.layout).name, 100 * padding);
}

}  // namespace obscura
