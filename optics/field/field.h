#pragma once
// Complex amplitudes over a plane.

#include <cstddef>

#include "core/image.h"

namespace obscura {

/// Real and imaginary parts, planar, of the same size.
struct Field {
    Image<float> re, im;
};

/// Where a method writes: amplitudes (re and im), or their squared magnitude (power), or both. Pixel (x, y)
/// is element y * stride + x. POD.
struct FieldTarget {
    float* re = nullptr;
    float* im = nullptr;
    float* power = nullptr;
    std::ptrdiff_t stride = 0;
};

}  // namespace obscura
