#pragma once
// Elementary functions whose bits do not depend on the CPU, the compiler or the C library.
//
// glibc chooses its double sin, cos, exp, log, pow and atan2 by the CPU's FMA, so their last bits vary;
// whatever reaches a pixel calls these instead. They use + - * /, sqrt, floor and bit operations only, which
// IEEE 754 rounds in one way.
//
// Accuracy: within 1 ulp of the true value, checked in tests/core/num_test.cpp. Zeros, infinities,
// NaN and domain errors are those of C99 annex F; nothing sets errno or relies on floating-point flags.

namespace obscura::num {

inline constexpr double pi = 3.14159265358979323846;

/// Angles in radians. Accurate for |x| <= 2^20; a larger x is first reduced by the double nearest to 2 pi,
/// whose error grows to |x| * 4e-17 rad (the result is still the same on every CPU and in range).
double sin(double x);
double cos(double x);
double tan(double x);

/// Angles in degrees, any finite x: exact at every multiple of 90.
double sin_deg(double x);
double cos_deg(double x);

/// Radians: asin in [-pi/2, pi/2], acos in [0, pi], atan in [-pi/2, pi/2], atan2 in [-pi, pi].
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);

/// Exact at integers that have exact results (exp2), gradual underflow included.
double exp(double x);
double exp2(double x);

/// Natural and binary logarithm; log2 is exact at powers of two.
double log(double x);
double log2(double x);

double pow(double x, double y);
double cbrt(double x);

}  // namespace obscura::num
