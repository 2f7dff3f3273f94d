#pragma once
// Rows of amplitudes into a target.

#include "optics/field.h"

namespace obscura {

/// Row y of `target`: amplitudes, power, or both, of `count` pixels from the left.
void put_row(const FieldTarget& target, int y, int count, const float* re, const float* im);

}  // namespace obscura
