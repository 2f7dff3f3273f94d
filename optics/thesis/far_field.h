#pragma once
// The thesis's sums over quads: far fields by what section 3.4.1 says, step by step from the equation to as
// few products as quads allow. They write rows of `target` where target.stride >= grid.width, as those of
// optics/far_field_methods.h do, which are always cheaper: no planner chooses these.

#include "core/isa.h"
#include "optics/field/field.h"
#include "optics/field/frequency_grid.h"
#include "optics/field/quads.h"

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

/// By the quads' sizes. Natural grids (optics/field/natural_grid.h) only; throws InputError on others.
void far_field_levels(const QuadList& quads, const FrequencyGrid& grid, const FieldTarget& target,
                      const Exec& exec);

}  // namespace obscura
