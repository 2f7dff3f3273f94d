#pragma once
// One descent through a serialised tree of any code, one node at a time: the scalar half of every lookup.
// POD: kernels include this; every function is inlined, so that no object exports one.
//
// Scandolo, Bauszat, Eisemann 2016, section 3.2 (traversal) and figure 5 (the lowest common node of several
// points is where the bits of their coordinates part).
//
// A code gives, as static functions (mh_step.h, mmh_step.h and dag_step.h):
//   root(tree)                         where every descent starts: the root has a value
//   child(tree, place, height, x, y)   from a node of height `height` (>= 1) to its child that holds texel
//                                      (x, y); the descent must not have ended
//   depth(tree, place)                 the depth that the values on the way come to
//   varies                             whether that may differ from texel to texel where a descent ends; then
//                                      depth(tree, place, x, y)

#include <cstdint>

#include "hierarchy/dag/dag_step.h"
#include "hierarchy/facet/facet_step.h"
#include "hierarchy/mh/mh_step.h"
#include "hierarchy/mmh/mmh_step.h"
#include "hierarchy/tree_code.h"

namespace obscura {

/// Calls f(Code{}) with what reads the tree.
template <class F>
OBSCURA_TREE_INLINE auto with_code(const TreeCode& tree, F&& f) {
    if (tree.code == ShadowCode::mmh) return f(MmhCode{});
    if (tree.code == ShadowCode::dag) return f(DagCode{});
    if (tree.code == ShadowCode::facet) return f(FacetCode{});
    return with_mh_layout(tree, f);
}

/// The coordinate of the texel that stands for a square of 2^level texels where values vary: its middle one.
OBSCURA_TREE_INLINE std::int32_t middle_of(std::int32_t x, int level) {
    return level == 0 ? x : (x >> level << level) | 1 << (level - 1);
}

/// Depth of the square of 2^level texels that holds texel (x, y), at `place`, where its descent ended.
template <class Code>
OBSCURA_TREE_INLINE float depth_of(const TreeCode& tree, TreePlace place, std::int32_t x, std::int32_t y,
                                   int level) {
    if constexpr (Code::varies) {
        return Code::depth(tree, place, middle_of(x, level), middle_of(y, level));
    } else {
        return Code::depth(tree, place);
    }
}

/// Height of the lowest node that holds both points whose coordinates differ in `bits` (x bits | y bits).
OBSCURA_TREE_INLINE int common_height(std::uint32_t bits) {
    return bits == 0 ? 0 : 32 - __builtin_clz(bits);
}

/// The way from the root to a texel, kept so that the next texel's descent starts where the two ways part. It
/// has no use for a top grid: neighbours seldom part so far up.
struct TreePath {
    TreePlace at[max_tree_levels + 1];  ///< by height, from `bottom` up
    std::int32_t x = 0, y = 0;
    std::int32_t bottom = 0;  ///< where the descent ended, or how far it was asked for
    std::int32_t steps = 0;   ///< headers read so far
};

template <class Code>
OBSCURA_TREE_INLINE void start_path(const TreeCode& tree, TreePath& path) {
    path.bottom = tree.levels;
    path.at[tree.levels] = Code::root(tree);
    path.x = path.y = path.steps = 0;
}

/// Turns the path to (x, y). Returns where its descent stands at `height`: at a node of that height, or
/// ended.
template <class Code>
OBSCURA_TREE_INLINE TreePlace extend_path(const TreeCode& tree, std::int32_t x, std::int32_t y, int height,
                                          TreePath& path) {
    const int parted = common_height(static_cast<std::uint32_t>((path.x ^ x) | (path.y ^ y)));
    path.x = x;
    path.y = y;
    if (path.bottom < parted) path.bottom = parted;
    if (path.bottom <= height) return path.at[height];
    TreePlace place = path.at[path.bottom];
    while (path.bottom > height && place.node != no_tree_node) {
        place = Code::child(tree, place, path.bottom, x, y);
        path.at[--path.bottom] = place;
        ++path.steps;
    }
    return place;
}

}  // namespace obscura
