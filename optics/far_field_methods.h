#pragma once
// The strategies behind far_field(): each computes the same function over a grid, in its own way. They write
// rows of `target` where target.stride >= grid.width; power, amplitudes or both (see optics/field.h). Phases
// are taken modulo one turn in double before they become floats, so that large frequencies lose nothing.

#include "core/isa.h"
#include "optics/aperture.h"
#include "optics/far_field.h"
#include "optics/field.h"
#include "optics/quads.h"
#include "optics/row_runs.h"

namespace obscura {

/// Equations 3.9 and 3.13: quads x pixels.
void far_field_direct(const QuadList& quads, const FrequencyGrid& grid, const FieldTarget& target,
                      const Exec& exec);

/// Equation 3.14: one transform per shape (width x height), one phase per quad.
void far_field_shift(const QuadList& quads, const FrequencyGrid& grid, const FieldTarget& target,
                     const Exec& exec);

/// One complex matrix product, [rows x quads] times [quads x columns].
void far_field_gemm(const QuadList& quads, const FrequencyGrid& grid, const FieldTarget& target,
                    const Exec& exec);

/// One matrix product over the distinct columns (or rows, where they are fewer) at which the mask changes.
/// `cull`: see FarFieldParams; blocks are counted in `report` when it is not null.
void far_field_edges(ImageView<const float> mask, const FrequencyGrid& grid, double cull,
                     const FieldTarget& target, const Exec& exec, FarFieldReport* report);

/// Natural grids (optics/natural_grid.h) only.
void far_field_levels(const QuadList& quads, const FrequencyGrid& grid, const FieldTarget& target,
                      const Exec& exec);

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

}  // namespace obscura
