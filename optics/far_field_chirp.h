#pragma once
// The runs method away from natural grids: any window, any step.

#include "core/image.h"
#include "core/isa.h"
#include "optics/far_field.h"
#include "optics/field/field.h"
#include "optics/field/natural_grid.h"
#include "optics/field/row_runs.h"

namespace obscura {

/// F of a mask over any grid; see optics/far_field_methods.h.
void far_field_chirp(ImageView<const float> mask, const RowRuns& runs, const FrequencyGrid& grid,
                     const FieldTarget& target, const Exec& exec);

/// log2 of the transforms it would use: the cheapest cut of the grid's rows into tiles. 0 when there is none:
/// masks of more than 65536 rows.
int chirp_log2_length(int mask_height, int grid_height);

/// Of a natural grid, whether the transforms over its whole period cost less than those of the window: true
/// but for small windows of very fine grids.
bool natural_is_cheaper(const NaturalGrid& natural, int mask_height, const FrequencyGrid& grid);

}  // namespace obscura
