#pragma once
// Pictures of a few bright pixels and kernels without a pattern, and sums of their light.

#include <algorithm>
#include <cstdint>

#include "core/image.h"
#include "core/vec.h"
#include "optics/glare.h"

namespace obscura {

/// Positive numbers without a pattern, in [0, 1).
struct Dice {
    std::uint32_t state = 1;
    float operator()() {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) / 16777216.0f;
    }
};

inline Image<Vec3f> random_kernel(int side, std::uint32_t seed) {
    Dice dice{seed};
    Image<Vec3f> kernel(side, side);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const auto d =
                static_cast<float>((x - side / 2) * (x - side / 2) + (y - side / 2) * (y - side / 2));
            const float fall = 1 / (1 + d);
            kernel(x, y) = {dice() * fall, dice() * fall, dice() * fall};
        }
    }
    return unit_kernel(kernel);
}

/// A dim picture with `lamps` bright pixels, `seed` decides where.
inline Image<Vec3f> night(int width, int height, int lamps, std::uint32_t seed) {
    Dice dice{seed};
    Image<Vec3f> picture(width, height);
    for (Vec3f& p : picture.pixels)
        p = {dice(), dice(), dice()};
    for (int i = 0; i < lamps; ++i) {
        const auto x = static_cast<int>(dice() * static_cast<float>(width)),
                   y = static_cast<int>(dice() * static_cast<float>(height));
        picture(x, y) = {100 * dice(), 2 + 100 * dice(), 100 * dice()};
    }
    return picture;
}

inline double sum(const Image<Vec3f>& image) {
    double total = 0;
    for (const Vec3f& p : image.pixels)
        total += static_cast<double>(p.x) + static_cast<double>(p.y) + static_cast<double>(p.z);
    return total;
}

inline float largest(const Vec3f& p) {
    return std::max({p.x, p.y, p.z});
}

inline double bright_sum(const Image<Vec3f>& image, float clip) {
    double total = 0;
    for (const Vec3f& p : image.pixels) {
        if (largest(p) > clip)
            total += static_cast<double>(p.x) + static_cast<double>(p.y) + static_cast<double>(p.z);
    }
    return total;
}

}  // namespace obscura
