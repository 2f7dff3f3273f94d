#pragma once
// A disparity system as a matrix on a grid, and its coarser likenesses for the V-cycle.
//
// Brandt, "Multi-Level Adaptive Solutions to Boundary-Value Problems", 1977; Trottenberg, Oosterlee,
// Schueller, "Multigrid", 2001, chapters 2 and 5 (cell-centred grids); Brandt, McCormick, Ruge, "Algebraic
// multigrid for sparse matrix equations", 1984, for interpolation that follows the equation.
//
// Where plain multigrid fails on these systems, and what is done here:
//
// Matching sets. Many pixels follow one source pixel: one dense row. Its error is a spike, which no coarse
// grid of pixels can hold. So the source is no pixel of the grid: it is a *hub*, an unknown of its own that
// exists on every level, coupled to cells. On the coarsest level hubs and cells are solved together, exactly.
//
// Anchors and members. Summed over the pixels of a coarse cell, the pull of an anchored area grows fourfold
// per level while the stiffness between cells stays, and at the area's border smooth interpolation carries
// corrections to pixels that cannot move. Where the pull exceeds a share of a row's diagonal, interpolation
// follows the row's own equation: neighbours count only by what the pull leaves, and of members the hub
// counts with the rest. Coarse pulls are then those of the interpolated values (lumped), and so are the
// hubs' own terms.
//
// Masks. Cells without a valid pixel hold nothing; interpolation shares their part out among the others.

#include <cstdint>
#include <vector>

#include "core/isa.h"
#include "stereo/disparity_system.h"
#include "stereo/solver/grid_plane.h"

namespace obscura {

/// One entry between a cell and a hub: the matrix has -weight there.
struct Coupling {
    std::int32_t x = 0;
    std::uint32_t hub = 0;
    float weight = 0;
    float share = 0;  ///< of the hub in this cell's interpolation: weight / diagonal, or 0 where smooth
};

struct GridLevel {
    int width = 0, height = 0;
    float uniform_edge = 0;  ///< weight of all edges between unknowns (finest level); 0: edge_x, edge_y
    GridPlane edge_x;        ///< between (x, y) and (x + 1, y)
    GridPlane edge_y;        ///< between (x, y) and (x, y + 1)
    GridPlane diagonal;      ///< 0 where the cell is no unknown
    GridPlane relax;         ///< omega / diagonal, 0 where the cell is no unknown
    GridPlane scale;         ///< of interpolation into this cell; empty: 1 everywhere
    std::vector<std::uint32_t> coupling_rows;  ///< row y's couplings begin at [y]; height + 1 entries
    std::vector<Coupling> couplings;           ///< ascending in (y, x, hub)
    std::vector<double> hub_matrix;            ///< hubs x hubs, row-major
    GridPlane rhs, solution;                   ///< of the V-cycle; not on the finest level
};

/// Calls fn(coupling) for those of row y, ascending in x.
template <class Level, class Fn>
void for_couplings(Level& level, int y, Fn&& fn) {
    if (level.couplings.empty()) return;
    const auto row = static_cast<std::size_t>(y);
    for (std::uint32_t i = level.coupling_rows[row]; i < level.coupling_rows[row + 1]; ++i)
        fn(level.couplings[i]);
}

constexpr double jacobi_damping = 0.8;

struct GridHierarchy {
    std::vector<GridLevel> levels;  ///< finest first
    struct Pixel {
        std::int32_t x = 0, y = 0;
    };
    std::vector<Pixel> hubs;             ///< source pixels, ascending in (y, x), each once
    std::vector<std::int32_t> unknowns;  ///< coarsest level: cell indices; then come the hubs
    std::vector<double> factor;          ///< Cholesky factor of the coarsest level
    /// Of all levels, with unknowns of the finer one that have no edge within.
    std::int64_t shared_cells = 0;
};

/// Levels of the system's matrix down to at most 8 x 8 cells. Sets whose source is not valid are left out.
/// The same bits for any exec.
GridHierarchy grid_hierarchy(const DisparitySystem& system, const Exec& exec);

/// Of hierarchy.hubs; -1 when (x, y) is none.
int hub_at(const GridHierarchy& hierarchy, int x, int y);

/// Two systems have the same matrix: another right side can use the same hierarchy.
bool same_matrix(const DisparitySystem& a, const DisparitySystem& b);

}  // namespace obscura
