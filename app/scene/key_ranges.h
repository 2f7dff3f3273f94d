#pragma once
// Ranges that many keys have.

#include "app/scene/schema.h"

namespace obscura::key_ranges {

constexpr double far_away_m = 1e9;
constexpr Range positive{0, far_away_m, true, false};
constexpr Range anywhere{-far_away_m, far_away_m};
constexpr Range turns{-36000, 36000};
constexpr Range brightness{0, 1e9};
constexpr Range unit_share{0, 1};

}  // namespace obscura::key_ranges
