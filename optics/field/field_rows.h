#pragma once
// Rows of amplitudes into a target.

#include "core/isa.h"
#include "optics/field/field.h"

namespace obscura {

/// Row y of `target`: amplitudes, power, or both, of `count` pixels from the left.
void put_row(const FieldTarget& target, int y, int count, const float* re, const float* im);

/// Zeros, in every part of `target` that there is.
void clear(const FieldTarget& target, int width, int height, const Exec& exec);

}  // namespace obscura
