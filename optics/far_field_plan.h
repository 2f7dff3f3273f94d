#pragma once
// The planner, given what the methods need as well: one search for runs serves both.

#include "optics/far_field.h"
#include "optics/field/row_runs.h"

namespace obscura {

/// plan_far_field() with the runs of the aperture's mask.
FarFieldReport plan_far_field(const Aperture& aperture, const RowRuns& runs, const FrequencyGrid& grid,
                              const FarFieldParams& params);

/// Throws InputError unless the grid has pixels and its steps are positive, its frequencies finite.
void check_grid(const FrequencyGrid& grid);

}  // namespace obscura
