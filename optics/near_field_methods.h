#pragma once
// The strategies behind near_field(): each computes the same field, in its own way, into rows of `target`
// (target.stride >= grid.width). Those that only teach are in optics/thesis/near_field.h.

#include "core/isa.h"
#include "optics/field/field.h"
#include "optics/field/near_field_case.h"
#include "optics/near_field.h"

namespace obscura {

/// The mask to compute with and the plane in its texels; `coarse` keeps the mask if it is not the aperture's
/// own. Throws InputError for lengths and positions that mean nothing.
NearFieldCase near_field_case(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                              Aperture& coarse);

/// The planner's choice, or the method that `params` names. Throws InputError when that cannot serve the
/// plane or cannot cull.
NearFieldReport plan_near_field_case(const NearFieldCase& c, const NearFieldParams& params);

/// As few products as the mask has distinct columns (or rows, where they are fewer). Writes the counts of
/// blocks to `report` when `cull` > 0.
void near_field_edges(const NearFieldCase& c, double cull, const FieldTarget& target, const Exec& exec,
                      NearFieldReport& report);

/// Runs of rows by their ends, then convolutions of columns. step = p / q, q <= 16, and less than 2^16 texels
/// of mask and plane together.
void near_field_hybrid(const NearFieldCase& c, const FieldTarget& target, const Exec& exec);

/// Convolutions of rows, then of columns: the kernel is a product, so the two-dimensional transform falls
/// apart. The grids of the hybrid, in both axes.
void near_field_fft(const NearFieldCase& c, const FieldTarget& target, const Exec& exec);

}  // namespace obscura
