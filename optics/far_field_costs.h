#pragma once
// What each strategy costs, in nanoseconds on one thread: constants fitted once to measurements, so that a
// choice is the same everywhere. One function beside each strategy.

#include <cstdint>

#include "optics/far_field.h"

namespace obscura {

double far_field_direct_cost_ns(std::int64_t quads, const FrequencyGrid& grid);

}  // namespace obscura
