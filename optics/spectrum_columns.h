#pragma once
// The second of two one-dimensional transforms, shared by the methods on natural grids: sums of all rows for
// sixteen columns go in, the grid's pixels come out. See optics/column_store.h for which columns serve which.

#include <vector>

#include "core/isa.h"
#include "filters/fft.h"
#include "optics/column_store.h"
#include "optics/field/natural_grid.h"

namespace obscura {

/// Sums over rows that stand for the columns j = 16 group to 16 group + 15 of a period, M / 2 at most.
int column_groups(const NaturalAxis& u);

/// Strips of a grid that one group serves, with their factors. Owns what its ColumnStrips point to.
struct GroupStrips {
    std::vector<ColumnStrip> strips;
    std::vector<float> factors;       ///< re, im, power: 48 per strip
    std::vector<std::uint8_t> lanes;  ///< 16 per strip that is not whole
};

/// Complex factor of a column, and its squared magnitude.
struct ColumnFactor {
    float re = 0, im = 0, power = 0;
};

/// Columns as the general methods leave them: complex sums, j = 0 and j = M / 2 kept apart (see
/// store_real_pair).
GroupStrips complex_strips(const NaturalAxis& u, int group, const AxisFactors& factors);

/// Columns of a mask that is the same left and right, of even width: the real sums over the runs of the
/// imaginary part of e^(-2 pi i u x), x from the mask's middle; nothing at j = 0, see optics/low_columns.h.
GroupStrips mirror_strips(const NaturalAxis& u, int group);

/// The columns j = 0 and j = M / 2, whose sums are real: transformed together as lane 0 of the first group,
/// one the real, the other the imaginary part, which was multiplied by `scale`: that is undone here.
void store_real_pair(const float* re, const float* im, float scale, const SpectrumRows& rows,
                     const NaturalAxis& u, const AxisFactors& factors, const FieldTarget& target);

/// Zeros in the columns congruent to M / 2: there a mask that is the same left and right, of even width, has
/// nothing.
void clear_half_period(const NaturalAxis& u, int rows, const FieldTarget& target);

/// How many groups (or pairs of groups) are transformed before they are written, so that what neighbours
/// write is contiguous: as many as a megabyte holds, fewer when threads would be idle. No result depends on
/// it.
int groups_at_once(int groups, int length, const Exec& exec);

SpectrumRows spectrum_rows(const NaturalAxis& v, const FftPlan& plan, const AxisFactors& factors);

}  // namespace obscura
