#pragma once
// Value noise: smooth chance in space, the same on every machine (integers and + - * only).

#include <cstdint>

#include "core/vec.h"

namespace obscura {

/// In [-1, 1], of features about 1 wide; smooth in p.
double value_noise(Vec3d p, std::int64_t seed);

/// Sum of `octaves` noises, each twice as fine and half as strong; in (-2, 2).
double fractal_noise(Vec3d p, int octaves, std::int64_t seed);

}  // namespace obscura
