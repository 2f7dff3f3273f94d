#pragma once
// What lookups in trees must find.

#include "hierarchy/multires.h"

namespace obscura {

/// Value of the square of 2^level texels that holds (x, y): plain descent that stops there.
inline float value_at_level(const MultiresTree& tree, std::uint32_t x, std::uint32_t y, int level) {
    const MultiresNode* node = &tree.root;
    float value = node->value;
    for (int h = tree.levels - 1; h >= level; --h) {
        const int child = static_cast<int>((x >> h & 1u) + 2 * (y >> h & 1u));
        const ChildKind kind = node->child(child);
        if (kind == ChildKind::none) break;
        std::uint64_t place = node->first_child();
        for (int i = 0; i < child; ++i)
            place += node->child(i) != ChildKind::none;
        node = &tree.nodes[place];
        if (kind != ChildKind::empty) value = node->value;
    }
    return value;
}

}  // namespace obscura
