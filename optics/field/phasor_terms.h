#pragma once
// Constants that the scalar and the sixteen-lane phasor share. The polynomials are those of S. Moshier's
// Cephes library (sinf, cosf): sine and cosine of an angle a of at most pi / 4, in z = a^2.

namespace obscura::phasor_terms {

/// Adding and subtracting it rounds a double below 2^51 to the nearest integer, ties to even.
inline constexpr double rounder = 6755399441055744.0;
inline constexpr double two_pi = 6.283185307179586476925;
inline constexpr float pi = 3.14159265358979f;

/// sine = a (1 + z (s1 + z (s2 + z s3)))
inline constexpr float s1 = -1.6666654611e-1f, s2 = 8.3321608736e-3f, s3 = -1.9515295891e-4f;
/// cosine = 1 - z / 2 + z^2 (c2 + z (c3 + z c4))
inline constexpr float c2 = 4.166664568298827e-2f, c3 = -1.388731625493765e-3f, c4 = 2.443315711809948e-5f;

/// Derivative of sin(a) / a = -a / 3 (1 + z (d1 + z (d2 + z d3))), the Taylor series.
inline constexpr float d1 = -1.0f / 10, d2 = 1.0f / 280, d3 = -1.0f / 15120;

/// Below this many turns' width, sinc is the sine's own polynomial and needs no division.
inline constexpr float short_of_turn = 0.25f;

}  // namespace obscura::phasor_terms
