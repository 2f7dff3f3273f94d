#pragma once
// Noise that is smooth, seeded, and has the same bits everywhere.

#include <array>
#include <cstdint>

namespace obscura {

/// Three words to three, well mixed: M. Jarzynski, M. Olano: Hash functions for GPU rendering, JCGT 9(3),
/// 2020, "pcg3d".
std::array<std::uint32_t, 3> hash3(std::uint32_t x, std::uint32_t y, std::uint32_t z);

/// Numbers in [0, 1) of one item: its own, whatever other items there are.
struct ItemRandom {
    std::uint32_t item = 0, stream = 0, seed = 0;
    std::uint32_t drawn = 0;
    double next();
};

/// K. Perlin: Improving noise, 2002, in two dimensions: quintic blends of gradients at whole coordinates, of
/// sixteen directions. 0 at whole coordinates, mean 0, |value| <= 1 / sqrt(2).
double perlin_noise(double x, double y, std::uint32_t seed);

/// Sum of `octaves` >= 1, each twice as fine and half as strong as the one before, divided by the sum of the
/// strengths: |value| <= 1 / sqrt(2).
double fractal_noise(double x, double y, int octaves, std::uint32_t seed);

}  // namespace obscura
