#pragma once
// One descent through a serialised tree, one node at a time: the scalar half of every lookup. POD: kernels
// include this; every function is inlined, so that no object exports one.
//
// Scandolo, Bauszat, Eisemann 2016, section 3.2 (traversal with lazy fetching: only the place of the last
// value is carried, the value itself is read once) and figure 5 (the lowest common node of several points is
// where the bits of their coordinates part).

#include <cstdint>

#include "hierarchy/tree_code.h"

#define OBSCURA_TREE_INLINE inline __attribute__((always_inline))

namespace obscura {

/// What a layout's numbers are, in units (words or bytes).
template <TreeLayout layout>
struct TreeUnits {
    static constexpr bool bytes = row_of(layout).bytes;
    static constexpr std::uint32_t unit_bytes = bytes ? 1 : 4;
    static constexpr std::uint32_t header = bytes ? 3 : 1;
    static constexpr std::uint32_t low_bit = bytes ? 4 : 1, high_bit = bytes ? 3 : 1;  ///< of a child's kind
    static constexpr std::uint32_t offset_mask = (1u << row_of(layout).offset_bits) - 1;
};

/// Calls f(TreeUnits<layout>{}) for the tree's layout.
template <int row = tree_layout_count - 1, class F>
OBSCURA_TREE_INLINE auto with_layout(const TreeCode& tree, F&& f) {
    constexpr TreeLayout layout = tree_layouts[row].layout;
    if constexpr (row > 0) {
        if (tree.layout != layout) return with_layout<row - 1>(tree, f);
    }
    return f(TreeUnits<layout>{});
}

template <class Units>
OBSCURA_TREE_INLINE std::uint32_t tree_unit(const TreeCode& tree, std::uint32_t at) {
    std::uint32_t word;
    __builtin_memcpy(&word, tree.units + static_cast<std::uint64_t>(at) * Units::unit_bytes, sizeof word);
    return word;
}

template <class Units>
OBSCURA_TREE_INLINE float unit_value(const TreeCode& tree, std::uint32_t at) {
    const std::uint32_t word = tree_unit<Units>(tree, at);
    float value;
    __builtin_memcpy(&value, &word, sizeof value);
    return value;
}

/// Where every descent starts. (A TopNode is where any descent stands: see tree_code.h.)
template <class Units>
OBSCURA_TREE_INLINE TopNode tree_root() {
    return {0, Units::header};
}

/// From a node of height `height` (>= 1) to its child that holds texel (x, y). The descent must not have
/// ended.
template <class Units>
OBSCURA_TREE_INLINE TopNode tree_child(const TreeCode& tree, TopNode at, int height, std::int32_t x,
                                       std::int32_t y) {
    const std::uint32_t header = tree_unit<Units>(tree, at.node);
    // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): no descent goes below height 1
    const int bit = (x >> (height - 1) & 1) * 2 + (y >> (height - 1) & 1) * 4;
    const std::uint32_t kind = header >> bit & 3u;
    const std::uint32_t below = header & ((1u << bit) - 1u);
    const auto low = static_cast<std::uint32_t>(__builtin_popcount(below & 0x15u)),
               high = static_cast<std::uint32_t>(__builtin_popcount(below & 0x2au));
    const std::uint32_t child = at.node + (header >> 8 & Units::offset_mask) * tree.offset_scale[height] +
                                low * Units::low_bit + high * Units::high_bit;
    // Kinds: low bit, it has a value; high bit, it has children, and a header before the value.
    const std::uint32_t value = child + (kind >> 1) * Units::header;
    return {(kind & 2u) != 0 ? child : no_tree_node, (kind & 1u) != 0 ? value : at.value};
}

/// Height of the lowest node that holds both points whose coordinates differ in `bits` (x bits | y bits).
OBSCURA_TREE_INLINE int common_height(std::uint32_t bits) {
    return bits == 0 ? 0 : 32 - __builtin_clz(bits);
}

/// The way from the root to a texel, kept so that the next texel's descent starts where the two ways part. It
/// has no use for a top grid: neighbours seldom part so far up.
struct TreePath {
    TopNode at[max_tree_levels + 1];  ///< by height, from `bottom` up
    std::int32_t x = 0, y = 0;
    std::int32_t bottom = 0;  ///< where the descent ended, or how far it was asked for
    std::int32_t steps = 0;   ///< headers read so far
};

template <class Units>
OBSCURA_TREE_INLINE void start_path(const TreeCode& tree, TreePath& path) {
    path.bottom = tree.levels;
    path.at[tree.levels] = tree_root<Units>();
    path.x = path.y = path.steps = 0;
}

/// Turns the path to (x, y). Returns where its descent stands at `height`: at a node of that height, or
/// ended.
template <class Units>
OBSCURA_TREE_INLINE TopNode extend_path(const TreeCode& tree, std::int32_t x, std::int32_t y, int height,
                                        TreePath& path) {
    const int parted = common_height(static_cast<std::uint32_t>((path.x ^ x) | (path.y ^ y)));
    path.x = x;
    path.y = y;
    if (path.bottom < parted) path.bottom = parted;
    if (path.bottom <= height) return path.at[height];
    TopNode place = path.at[path.bottom];
    while (path.bottom > height && place.node != no_tree_node) {
        place = tree_child<Units>(tree, place, path.bottom, x, y);
        path.at[--path.bottom] = place;
        ++path.steps;
    }
    return place;
}

}  // namespace obscura
