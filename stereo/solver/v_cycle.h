#pragma once
// One V-cycle with one damped Jacobi sweep down and one up: the preconditioner, and a solver for lessons.
//
// Brandt 1977; Tatebe, "The multigrid preconditioned conjugate gradient method", 1993, for when a V-cycle is
// symmetric: the same sweeps both ways, restriction the transpose of interpolation. Hubs are not smoothed,
// only corrected (see grid_hierarchy.h). Each half of a cycle is one pass over a level: sweep, residual and
// restriction going down, interpolation and sweep going up, row by row through a few rows of cache.

#include <vector>

#include "core/stopwatch.h"
#include "stereo/solver/grid_hierarchy.h"
#include "stereo/solver/grid_rows.h"

namespace obscura {

/// A right side, or a solution: cells of the finest level, and hubs.
struct GridVector {
    GridPlane cells;
    std::vector<double> hubs;
};
/// Zero.
GridVector grid_vector(const GridHierarchy& hierarchy);
/// The frame is 0, the rest must be written first (GridPlane::framed).
GridVector framed_vector(const GridHierarchy& hierarchy);

/// Seconds spent per level, added to; empty: not measured.
using LevelSeconds = std::vector<double>;

/// Adds the time that it lives to a level's.
class LevelClock {
  public:
    LevelClock(LevelSeconds& seconds, std::size_t level) : seconds_(seconds), level_(level) {}
    ~LevelClock() {
        if (level_ < seconds_.size()) seconds_[level_] += clock_.seconds();
    }

  private:
    LevelSeconds& seconds_;
    std::size_t level_;
    Stopwatch clock_;
};

/// r = r_before - alpha q, then z = V r, where V is one V-cycle from zero. Of the cells only: r.hubs must be
/// up to date already. `r` may not be `r_before`. Returns the dot product r . z, hubs included. The levels'
/// rhs and solution are working memory.
double v_cycle(GridHierarchy& hierarchy, const GridVector& r_before, const GridPlane& q, float alpha,
               GridVector& r, GridVector& z, const Exec& exec, LevelSeconds& seconds);

/// Edge weights of row y.
RowEdges row_edges(const GridLevel& level, int y);

/// First half of a cycle on level `fine`, from its right side `rhs`: the next level's rhs, and hub_rhs
/// becomes the hubs' right side there.
void descend(const GridLevel& fine, const GridPlane& rhs, GridLevel& coarse, std::vector<double>& hub_rhs,
             const Exec& exec);
/// Second half: `solution` out of the next level's; returns rhs . solution over the cells.
double ascend(const GridLevel& fine, const GridPlane& rhs, const GridLevel& coarse,
              const std::vector<double>& hubs, GridPlane& solution, const Exec& exec);
/// The coarsest level's solution out of its rhs, and the hubs' values out of theirs.
void solve_coarsest(GridHierarchy& hierarchy, std::vector<double>& hubs);

}  // namespace obscura
