#pragma once
// Coloured far fields as lesson 12 compares them.

#include "core/isa.h"
#include "core/pixel.h"
#include "optics/psf.h"
#include "optics/thesis/spectral_lookup.h"

namespace obscura {

constexpr double colour_reference_nm = 550;

/// Daylight by this many wavelengths, each with a pattern of its own.
Image<Vec3f> colour_of(const Aperture& aperture, const FrequencyGrid& grid, int wavelengths,
                       const Exec& exec);

/// The same by lookups in one power image with frequencies `step` apart (equation 3.16).
Image<Vec3f> looked_up_colour(const Aperture& aperture, const FrequencyGrid& grid, int wavelengths,
                              double step, PowerInterpolation interpolation, const Exec& exec);

/// Mean over the pixels with least <= radius < most (cycles per texel) of the sum of |a - b| over X, Y and Z,
/// relative to that of b.
double colour_error(const Image<Vec3f>& a, const Image<Vec3f>& b, const FrequencyGrid& grid, double least,
                    double most);

/// Logarithmic, luminance 1 is white; codes in steps of 5, which look the same and pack into half the bytes.
Image<Rgb8> log_picture(const Image<Vec3f>& colour, double decades, const Exec& exec);

/// A wavelength's own colour, as bright as a screen shows it.
Rgb8 hue_of(const SpectralSample& sample);

}  // namespace obscura
