#include "optics/perlin_noise.h"

#include <cmath>

#include "core/num.h"
#include "core/vec.h"

namespace obscura {
namespace {

std::array<Vec2d, 16> directions() {
    std::array<Vec2d, 16> all;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const double angle = 22.5 * static_cast<double>(k);
        all[k] = {num::cos_deg(angle), num::sin_deg(angle)};
    }
    return all;
}

/// 6 t^5 - 15 t^4 + 10 t^3: its second derivative is 0 at 0 and 1.
double fade(double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

}  // namespace

std::array<std::uint32_t, 3> hash3(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    constexpr std::uint32_t factor = 1664525, step = 1013904223;
    x = x * factor + step;
    y = y * factor + step;
    z = z * factor + step;
    const auto mix = [&] {
        x += y * z;
        y += z * x;
        z += x * y;
    };
    mix();
    x ^= x >> 16;
    y ^= y >> 16;
    z ^= z >> 16;
    mix();
    return {x, y, z};
}

double ItemRandom::next() {
    // The lowest bits of such products are the weakest: the upper 24 are enough.
    return (hash3(item, stream * 1024 + drawn++, seed)[0] >> 8) * 0x1p-24;
}

double perlin_noise(double x, double y, std::uint32_t seed) {
    static const std::array<Vec2d, 16> gradients = directions();
    const double x0 = std::floor(x), y0 = std::floor(y);
    const double dx = x - x0, dy = y - y0;
    const auto corner = [&](int i, int j) {
        const auto column = static_cast<std::uint32_t>(static_cast<std::int64_t>(x0) + i);
        const auto row = static_cast<std::uint32_t>(static_cast<std::int64_t>(y0) + j);
        const Vec2d& g = gradients[hash3(column, row, seed)[0] >> 28];
        return g.x * (dx - i) + g.y * (dy - j);
    };
    const double u = fade(dx), v = fade(dy);
    const double upper = corner(0, 0) + u * (corner(1, 0) - corner(0, 0));
    const double lower = corner(0, 1) + u * (corner(1, 1) - corner(0, 1));
    return upper + v * (lower - upper);
}

double fractal_noise(double x, double y, int octaves, std::uint32_t seed) {
    double sum = 0, strengths = 0, strength = 1;
    for (int k = 0; k < octaves; ++k) {
        // Turned by about 37 degrees from one to the next: the lattices' zeros do not meet.
        sum += strength * perlin_noise(x, y, seed + static_cast<std::uint32_t>(k));
        strengths += strength;
        strength *= 0.5;
        const double turned = 2 * (0.8 * x - 0.6 * y);
        y = 2 * (0.6 * x + 0.8 * y);
        x = turned;
    }
    return sum / strengths;
}

}  // namespace obscura
