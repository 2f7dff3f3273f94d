#pragma once
// Scalar twins of the comparisons of core/simd.h: what one lane of a kernel does, for the ref kernels.

namespace obscura {

/// a < b ? a : b, as the SSE instruction: with a NaN the second operand wins.
constexpr float lane_min(float a, float b) {
    return a < b ? a : b;
}
constexpr float lane_max(float a, float b) {
    return a > b ? a : b;
}
constexpr double lane_min(double a, double b) {
    return a < b ? a : b;
}
constexpr double lane_max(double a, double b) {
    return a > b ? a : b;
}

}  // namespace obscura
