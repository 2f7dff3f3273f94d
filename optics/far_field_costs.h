#pragma once
// What each strategy costs, in nanoseconds on one thread: constants fitted once to measurements, so that a
// choice is the same everywhere. One function beside each strategy.

#include <cstdint>

#include "optics/far_field.h"
#include "optics/quads.h"
#include "optics/separable_terms.h"

namespace obscura {

double far_field_direct_cost_ns(std::int64_t quads, const FrequencyGrid& grid);
double far_field_gemm_cost_ns(const QuadList& quads, const FrequencyGrid& grid);
double far_field_shift_cost_ns(const QuadList& quads, const FrequencyGrid& grid);
/// 1e300 for grids that are not natural.
double far_field_levels_cost_ns(const QuadList& quads, const FrequencyGrid& grid);
double far_field_polygon_cost_ns(const Outline& outline, const FrequencyGrid& grid);
/// Decomposes the mask to count its distinct columns (about a nanosecond a texel).
double far_field_edges_cost_ns(ImageView<const float> mask, const FrequencyGrid& grid);

/// Adding the terms of a difference of masks to a field.
double far_field_update_cost_ns(const SeparableTerms& difference, const FrequencyGrid& grid);

}  // namespace obscura
