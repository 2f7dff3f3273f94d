#pragma once
// Far fields as lesson 10 compares them: as a sum over quads, and by runs.

#include "core/isa.h"
#include "optics/far_field.h"
#include "optics/field/quads.h"

namespace obscura {

/// Equation 3.9 as it stands: the closed forms of all quads, added up.
Field field_of_quads(const QuadList& quads, const FrequencyGrid& grid, const Exec& exec);

/// Runs of rows by their ends, then FFTs over the rows.
Field field_of_runs(ImageView<const float> mask, const FrequencyGrid& grid, const Exec& exec);

Image<float> power_of(const Field& field);

/// Largest magnitude of a - b; same sizes.
double largest_difference(const Field& a, const Field& b);

}  // namespace obscura
