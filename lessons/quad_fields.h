#pragma once
// Far fields as lessons 10 and 18 compare them: as a sum over quads, by runs, and as the planner has it.

#include "core/isa.h"
#include "optics/far_field.h"
#include "optics/field/quads.h"

namespace obscura {

/// Equation 3.9 as it stands: the closed forms of all quads, added up.
Field field_of_quads(const QuadList& quads, const FrequencyGrid& grid, const Exec& exec);

/// Runs of rows by their ends, then FFTs over the rows.
Field field_of_runs(ImageView<const float> mask, const FrequencyGrid& grid, const Exec& exec);

/// What the planner chooses; the bits that update_far_field() starts from.
Field field_anew(const Image<float>& mask, const FrequencyGrid& grid, const Exec& exec);

Image<float> power_of(const Field& field);

/// Largest magnitude of a - b; same sizes.
double largest_difference(const Field& a, const Field& b);

}  // namespace obscura
