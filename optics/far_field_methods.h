#pragma once
// The strategies behind far_field() (those that only teach are in optics/thesis/far_field.h): each computes
// the same function over a grid, in its own way. They write rows of `target` where target.stride >=
// grid.width; power, amplitudes or both (see optics/field/field.h). Phases are taken modulo one turn in
// double before they become floats, so that large frequencies lose nothing.

#include "core/isa.h"
#include "optics/far_field.h"
#include "optics/field/aperture.h"
#include "optics/field/field.h"
#include "optics/field/row_runs.h"

namespace obscura {

/// One matrix product over the distinct columns (or rows, where they are fewer) at which the mask changes.
/// `cull`: see FarFieldParams; blocks are counted in `report` when it is not null.
void far_field_edges(ImageView<const float> mask, const FrequencyGrid& grid, double cull,
                     const FieldTarget& target, const Exec& exec, FarFieldReport* report);

/// Runs of rows (row_runs() of the mask), then FFTs over the rows: natural grids; chirp-z transforms: any
/// other.
void far_field_runs(ImageView<const float> mask, const RowRuns& runs, const FrequencyGrid& grid,
                    const FieldTarget& target, const Exec& exec);

/// Natural grids only.
void far_field_raster_fft(ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target,
                          const Exec& exec);

/// Disjoint outlines; `width` x `height` is the mask's size, whose centre is the origin.
void far_field_polygon(const Outline& outline, int width, int height, const FrequencyGrid& grid,
                       const FieldTarget& target, const Exec& exec);

/// What that costs on one thread, nanoseconds: a constant fitted once to measurements.
double far_field_polygon_cost_ns(const Outline& outline, const FrequencyGrid& grid);

}  // namespace obscura
