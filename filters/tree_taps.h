#pragma once
// The taps of one kernel on a tree, scalar: naive and shared, and the nodes they visit.

#include <algorithm>

#include "filters/pcf_place.h"
#include "hierarchy/codes/tree_step.h"

namespace obscura::ref {

/// A kernel's squares on a tree. Taps of points and spots are clamped into the map.
struct TreeTaps {
    const Kernel& kernel;
    const TreeCode& tree;
    bool clamp;

    std::int32_t last() const { return (1 << (tree.levels - kernel.level)) - 1; }
    std::int32_t x(int i) const { return clamp ? std::clamp(kernel.x0 + i, 0, last()) : kernel.x0 + i; }
    std::int32_t y(int j) const { return clamp ? std::clamp(kernel.y0 + j, 0, last()) : kernel.y0 + j; }
    bool inside(std::int32_t tx, std::int32_t ty) const {
        return tx >= 0 && ty >= 0 && tx <= last() && ty <= last();
    }
    bool all_inside() const { return inside(x(0), y(0)) && inside(x(kernel.side - 1), y(kernel.side - 1)); }
};

/// Value of square (x, y) of the kernel's level, inside the map, by a descent along `path`.
template <class Code>
float value_along(const TreeTaps& taps, std::int32_t x, std::int32_t y, TreePath& path) {
    const int level = taps.kernel.level;
    const TreePlace place = extend_path<Code>(taps.tree, x << level, y << level, level, path);
    // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): no level is negative
    return depth_of<Code>(taps.tree, place, x << level, y << level, level);
}

/// Every tap from the root; adds the nodes visited to `steps`.
template <class Code>
float naive_mean(const TreeTaps& taps, int& steps) {
    return taps.kernel.mean([&](int i, int j) {
        const std::int32_t x = taps.x(i), y = taps.y(j);
        if (!taps.inside(x, y)) return true;
        TreePath path;
        start_path<Code>(taps.tree, path);
        const float stored = value_along<Code>(taps, x, y, path);
        steps += path.steps;
        return taps.kernel.depth_at(i, j) <= stored;
    });
}

/// The taps of a kernel whose descents end in one place.
template <class Code>
float mean_of_one(const TreeTaps& taps, TreePlace place) {
    const Kernel& k = taps.kernel;
    const int end = k.side - 1;
    if constexpr (Code::varies) {
        return k.mean([&](int i, int j) {
            return k.depth_at(i, j) <=
                   depth_of<Code>(taps.tree, place, taps.x(i) << k.level, taps.y(j) << k.level, k.level);
        });
    } else {
        // One value for all taps: their extreme depths, which are at corners, may decide.
        const float value = Code::depth(taps.tree, place);
        const float corner[4] = {k.depth_at(0, 0), k.depth_at(end, 0), k.depth_at(0, end),
                                 k.depth_at(end, end)};
        if (*std::max_element(corner, corner + 4) <= value) return 1.0f;
        if (value < *std::min_element(corner, corner + 4)) return 0.0f;
        return k.mean([&](int i, int j) { return k.depth_at(i, j) <= value; });
    }
}

/// The taps together to their lowest common node, then one after the other; the path, which may come from
/// another kernel, counts the nodes visited.
template <class Code>
float shared_mean(const TreeTaps& taps, TreePath& path) {
    const Kernel& k = taps.kernel;
    const int end = k.side - 1;
    if (taps.all_inside()) {
        const std::int32_t x0 = taps.x(0), y0 = taps.y(0), x1 = taps.x(end), y1 = taps.y(end);
        const int height = k.level + common_height(static_cast<std::uint32_t>((x0 ^ x1) | (y0 ^ y1)));
        const TreePlace place = extend_path<Code>(taps.tree, x0 << k.level, y0 << k.level, height, path);
        if (place.node == no_tree_node || height == k.level) return mean_of_one<Code>(taps, place);
    }
    return k.mean([&](int i, int j) {
        const std::int32_t x = taps.x(i), y = taps.y(j);
        return !taps.inside(x, y) || k.depth_at(i, j) <= value_along<Code>(taps, x, y, path);
    });
}

}  // namespace obscura::ref
