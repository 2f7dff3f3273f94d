#pragma once
// Ranges that many keys have.

#include "app/scene/schema.h"

namespace obscura::key_ranges {

constexpr double far_away_m = 1e9;
constexpr Range positive{0, far_away_m, true, false};
/// Two points that give a direction, and what is scaled by their distance, stand no nearer than a micrometre.
constexpr double least_distance_m = 1e-6;
constexpr Range distance{least_distance_m, far_away_m};
constexpr Range anywhere{-far_away_m, far_away_m};
constexpr Range turns{-36000, 36000};
constexpr Range brightness{0, 1e9};
constexpr Range unit_share{0, 1};

}  // namespace obscura::key_ranges
