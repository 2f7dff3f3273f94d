// Rows of 16-bit floats, one number at a time: the lesson, and what the kernels must equal.
//
// A float times 2^-112 has, ten bits further up, the exponent that a half has; what is below those bits
// is rounded away. Halves below 2^-14 come out as the denormals that they are.

#include <bit>
#include <cmath>

#include "core/scalar_lanes.h"
#include "stereo/thesis/half_rows.h"

namespace obscura::ref {

void half_row(const float* x, int count, std::uint16_t* half) noexcept {
    for (int i = 0; i < count; ++i) {
        const float scaled = lane_min(std::abs(x[i]), 65504.0f) * 0x1p-112f;
        const auto bits = std::bit_cast<std::uint32_t>(scaled);
        const std::uint32_t sign = std::bit_cast<std::uint32_t>(x[i]) >> 31;
        half[i] = static_cast<std::uint16_t>(((bits + 0xfffu + (bits >> 13 & 1u)) >> 13) | sign << 15);
    }
}

void float_row(const std::uint16_t* half, int count, float* x) noexcept {
    for (int i = 0; i < count; ++i) {
        const auto size = std::bit_cast<float>((half[i] & 0x7fffu) << 13) * 0x1p112f;
        const auto sign = (half[i] & 0x8000u) << 16;
        x[i] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(size) | sign);
    }
}

}  // namespace obscura::ref
