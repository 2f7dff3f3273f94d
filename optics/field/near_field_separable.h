#pragma once
// The near field of separable terms: factors in panels, then one matrix product.

#include "optics/field/field.h"
#include "optics/field/near_field_case.h"
#include "optics/field/separable_field.h"
#include "optics/field/separable_terms.h"

namespace obscura {

/// U of the terms, which make up c.mask, over the plane. Pixels of blocks that `blocks` leaves out become 0;
/// null: none. Mirror symmetry of mask and plane together is used.
void near_field_separable(const NearFieldCase& c, const SeparableTerms& terms, const BlockSet* blocks,
                          const FieldTarget& target, const Exec& exec);

}  // namespace obscura
