#pragma once
// Things one pixel wide before a sky (poles, wires, twigs): chains and trees of pixels that hang on the rest
// of a system by a single pixel. Two that stand close share coarse cells although nothing joins them, which a
// V-cycle cannot mend, and their slow swaying takes conjugate gradients an iteration per pole. But a pixel
// with one neighbour can be taken out of the system exactly, and then the next one.
//
// D. Spielman, S.-H. Teng, "Nearly-Linear Time Algorithms for Graph Partitioning, Graph Sparsification, and
// Solving Linear Systems", STOC 2004, partial Cholesky factorisation; O. Livne, A. Brandt, "Lean Algebraic
// Multigrid (LAMG)", SIAM J. Sci. Comput. 34(4), 2012, section 3.2: elimination of nodes of low degree before
// multigrid. Here of degree one alone, which leaves a system on the same grid.
//
// With all that pulls pixel p itself summed up as a (x_p - t)^2, and w (x_q - x_p - g)^2 to its neighbour q,
// the least over x_p is a w / (a + w) (x_q - t - g)^2: an anchor of q.

#include <cstdint>
#include <optional>
#include <vector>

#include "stereo/disparity_system.h"

namespace obscura {

/// A pixel that was taken out: x_p = (own_weight own_value + edge (x_q - rise)) / (own_weight + edge).
struct TreePixel {
    std::int32_t x = 0, y = 0;            ///< p
    std::int32_t root_x = 0, root_y = 0;  ///< q, its neighbour nearer to the rest
    double own_weight = 0, own_value = 0, edge = 0;
    double rise = 0;  ///< wanted x_q - x_p
};

struct WithoutTrees {
    DisparitySystem rest;           ///< the pixels are not valid here, what they pull at is anchored instead
    std::vector<TreePixel> pixels;  ///< in the order in which they were taken out
};

/// Trees of fewer pixels stay: outlines are full of them, and they do no harm.
constexpr std::int64_t least_tree = 8;

/// Nothing when no tree of least_tree pixels hangs on anything. Sources and members of matching sets stay.
std::optional<WithoutTrees> without_trees(const DisparitySystem& system);

/// Puts into x, which minimises `rest`, what minimises the whole system.
void put_trees_back(const std::vector<TreePixel>& pixels, DisparityMap& x);

}  // namespace obscura
