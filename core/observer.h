#pragma once
// What the eye makes of light: the CIE 1931 observer, and linear sRGB.

#include "core/vec.h"

namespace obscura {

constexpr double shortest_visible_nm = 380, longest_visible_nm = 780;

/// CIE 1931 2-degree observer, the multi-lobe fit of C. Wyman, P.-P. Sloan, P. Shirley: Simple analytic
/// approximations to the CIE XYZ color matching functions, JCGT 2(2), 2013. Within 0.014 of the standard's
/// table everywhere (whose values reach 1.77); never negative between 380 and 780 nm.
Vec3d observer_xyz(double wavelength_nm);

/// XYZ (Y = 1 is white) to linear sRGB and back (IEC 61966-2-1, white D65).
Vec3d srgb_from_xyz(Vec3d xyz);
Vec3d xyz_from_srgb(Vec3d rgb);

/// Y of a linear sRGB colour.
double srgb_luminance(Vec3d rgb);

/// Colours outside the sRGB gamut move towards the grey of their own luminance until no channel is negative;
/// others stay. Luminance is kept; colours without luminance become black.
Vec3d into_gamut(Vec3d rgb);

}  // namespace obscura
