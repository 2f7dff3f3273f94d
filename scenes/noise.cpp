// Lattice of random values with smooth interpolation between; Perlin, "An Image Synthesizer", SIGGRAPH 1985,
// has gradients instead of values at the lattice, which rocks do not need.

#include "scenes/noise.h"

#include <cmath>

#include "scenes/random.h"

namespace obscura {
namespace {

double lattice(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t seed) {
    const auto word = [](std::int64_t v) { return static_cast<std::uint64_t>(v); };
    Random random(word(x) * 0x9e3779b97f4a7c15u ^ word(y) * 0xc2b2ae3d27d4eb4fu ^
                  word(z) * 0x165667b19e3779f9u ^ word(seed) * 0xd6e8feb86659fd93u);
    random.next();
    return random.range(-1, 1);
}

double smooth(double t) {
    return t * t * t * (t * (6 * t - 15) + 10);
}

double mix(double a, double b, double t) {
    return a + (b - a) * t;
}

}  // namespace

double value_noise(Vec3d p, std::int64_t seed) {
    const Vec3d cell{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const Vec3d t{smooth(p.x - cell.x), smooth(p.y - cell.y), smooth(p.z - cell.z)};
    const auto x = static_cast<std::int64_t>(cell.x), y = static_cast<std::int64_t>(cell.y),
               z = static_cast<std::int64_t>(cell.z);
    const auto edge = [&](std::int64_t dy, std::int64_t dz) {
        return mix(lattice(x, y + dy, z + dz, seed), lattice(x + 1, y + dy, z + dz, seed), t.x);
    };
    return mix(mix(edge(0, 0), edge(1, 0), t.y), mix(edge(0, 1), edge(1, 1), t.y), t.z);
}

double fractal_noise(Vec3d p, int octaves, std::int64_t seed) {
    double sum = 0, strength = 1;
    for (int i = 0; i < octaves; ++i) {
        sum += strength * value_noise(p, seed + i);
        p = p * 2.0 + Vec3d{0.37, 0.71, 0.53};
        strength *= 0.5;
    }
    return sum;
}

}  // namespace obscura
