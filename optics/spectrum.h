#pragma once
// Light by wavelength, and what the eye makes of it.

#include <array>
#include <string>
#include <vector>

#include "core/vec.h"

namespace obscura {

constexpr double shortest_visible_nm = 380, longest_visible_nm = 780;

/// CIE 1931 2-degree observer, the multi-lobe fit of C. Wyman, P.-P. Sloan, P. Shirley: Simple analytic
/// approximations to the CIE XYZ color matching functions, JCGT 2(2), 2013.
Vec3d observer_xyz(double wavelength_nm);

enum class LightSource { d65, equal, blackbody, sodium, rgb_led, monochromatic };

struct LightSpectrum {
    LightSource source = LightSource::d65;
    double kelvin = 6500;        ///< blackbody
    double wavelength_nm = 550;  ///< monochromatic
};

/// Relative radiant power at a wavelength, of any scale; lines (sodium) have a stated width.
double spectral_power(const LightSpectrum& light, double wavelength_nm);

/// One wavelength of a quadrature and the linear sRGB colour that unit power density there adds. The colours
/// of all samples add up to the light's own colour with luminance 1.
struct SpectralSample {
    double wavelength_nm = 0;
    Vec3d rgb;
};

/// `count` samples, evenly spaced (fewer for lines).
std::vector<SpectralSample> spectral_samples(const LightSpectrum& light, int count);

/// XYZ (Y = 1 is white) to linear sRGB and back (IEC 61966-2-1, D65).
Vec3d srgb_from_xyz(Vec3d xyz);
Vec3d xyz_from_srgb(Vec3d rgb);

/// Colours outside the sRGB gamut move towards the grey of their own luminance until no channel is negative.
Vec3d into_gamut(Vec3d rgb);

}  // namespace obscura
