#pragma once
// The columns of the lowest frequencies along u, in double.

#include "optics/field/field.h"
#include "optics/field/row_runs.h"
#include "optics/natural_transform.h"

namespace obscura {

/// Writes the grid's columns u = 0 and u = 1 and -1 steps, those that it has. Closed forms cannot give the
/// first, and a column's share of the rounding in float goes as 1 / u: these three would have nine tenths of
/// it, which shows where the pattern is dark: along the whole column, for openings that half a turn leaves as
/// they are. `mirrored`: the mask is the same left and right, of even width.
void write_low_columns(const RowRuns& runs, bool mirrored, const NaturalTransform& transform,
                       const FieldTarget& target);

}  // namespace obscura
