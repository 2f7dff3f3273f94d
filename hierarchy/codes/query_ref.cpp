// Lookups in a serialised tree, one point at a time.

#include "hierarchy/codes/query.h"
#include "hierarchy/codes/tree_step.h"

namespace obscura::ref {
namespace {

/// Lazy fetching: the way down carries only the place of the last value.
template <class Code>
float value_of(const TreeCode& tree, std::int32_t x, std::int32_t y, int level) {
    TreePlace place = Code::root(tree);
    for (int height = tree.levels; height > level && place.node != no_tree_node; --height)
        place = Code::child(tree, place, height, x, y);
    return depth_of<Code>(tree, place, x, y, level);
}

}  // namespace

void stored_values(const TreeCode& tree, const std::int32_t* x, const std::int32_t* y, std::size_t count,
                   int level, float* value) noexcept {
    with_code(tree, [&]<class Code>(Code) {
        for (std::size_t i = 0; i < count; ++i)
            value[i] = value_of<Code>(tree, x[i], y[i], level);
    });
}

void visibility(const TreeCode& tree, const MapPoints& points, int level, std::uint16_t* lit) noexcept {
    const std::int32_t size = 1 << tree.levels;
    for (std::size_t i = 0; i < points.count; ++i) {
        const std::int32_t x = points.x[i], y = points.y[i];
        bool is_lit = true;
        if (x >= 0 && y >= 0 && x < size && y < size) {
            float stored = 0;
            stored_values(tree, &x, &y, 1, level, &stored);
            is_lit = points.depth[i] <= stored;
        }
        if (i % 16 == 0) lit[i / 16] = 0;
        lit[i / 16] = static_cast<std::uint16_t>(lit[i / 16] | (is_lit ? 1u << (i % 16) : 0u));
    }
}

void coherent_visibility(const TreeCode& tree, const MapPoints& points, int level,
                         std::uint16_t* lit) noexcept {
    visibility(tree, points, level, lit);
}

}  // namespace obscura::ref
