#pragma once
// Phasor sums over quads, level by level: what far_field_levels() is made of.

#include <vector>

#include "core/buffer.h"
#include "core/isa.h"
#include "optics/field/natural_grid.h"
#include "optics/field/quads.h"
#include "optics/field/separable_terms.h"

namespace obscura {

/// The square cells of one size that a list's quads consist of. A quad is cut into squares whose side is the
/// largest power of two that divides its place and size: quads of a quadtree are one such square, or two.
struct LevelCells {
    int side = 1;          ///< texels
    SeparableTerms terms;  ///< one term per distinct column; intervals stand for points at their middles
};

/// Where texel coordinates have their origin for sums of levels up to `side`: the multiple of it nearest to
/// the mask's centre, at or beyond it.
int level_origin(int extent, int side);

/// Levels from the finest that occurs to the coarsest, none left out (some may hold no cells). Coordinates
/// are relative to level_origin() of the coarsest.
std::vector<LevelCells> level_cells(const QuadList& quads);

/// T(j, k) = sum over cells of weight * e^(-2 pi i (j x / M_u + k y / M_v)), (x, y) the cells' middles, M the
/// grid's periods. A step of M / side samples turns every cell alike, by half a turn: T(j + M_u / side, k) =
/// -T(j, k), likewise in k, and T(-j, -k) is the conjugate. So half a period of columns and a period of rows
/// hold everything.
struct LevelSum {
    int period_u = 1, period_v = 1;  ///< M / side
    int columns = 1;                 ///< j = 0 to period_u / 2
    Buffer<float> re, im;            ///< rows k = -(period_v / 2) on, period_v of them

    /// T(first, k) to T(first + count - 1, k).
    void read_row(std::int64_t first, int count, std::int64_t k, float* to_re, float* to_im) const;
};

/// The sums of the finest level: every level's own cells and, of each coarser cell, its four parts.
LevelSum finest_sum(const std::vector<LevelCells>& levels, int period_u, int period_v, const Exec& exec);

}  // namespace obscura
