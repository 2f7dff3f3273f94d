#pragma once
// The thesis's sums over quads: near fields by what section 3.4.5 says. They write rows of `target`
// (target.stride >= c.grid.width), as those of optics/near_field_methods.h do, which the planner chooses
// from.

#include "core/isa.h"
#include "optics/field/field.h"
#include "optics/field/near_field_case.h"
#include "optics/field/quads.h"

namespace obscura {

/// Equation 3.19 as it stands: quads x pixels, in double.
void near_field_direct(const NearFieldCase& c, const QuadList& quads, const FieldTarget& target,
                       const Exec& exec);

/// "Efficient Rendering", two passes: the factors of every quad along x and along y, then their products.
void near_field_two_pass(const NearFieldCase& c, const QuadList& quads, const FieldTarget& target,
                         const Exec& exec);

}  // namespace obscura
