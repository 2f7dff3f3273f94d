#pragma once
// The light that falls on each pixel of a sensor: a pattern's power integrated over squares, for many
// wavelengths at once.
//
// A far field scales with wavelength, so one fine sampling of its power holds all colours; what a pixel
// gathers at one wavelength is the power over a square of that sampling, four entries of a summed-area table.
//
// F. C. Crow: Summed-area tables for texture mapping, SIGGRAPH 1984. Here the table is never whole in memory:
// the power is made and summed a band of columns at a time, and each band gives the pixel borders it holds.

#include <functional>
#include <vector>

#include "core/error.h"
#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "optics/far_field.h"

namespace obscura {

/// |F|^2 over a grid of frequencies; must be that of a real mask, equal at q and -q.
using PowerSource = std::function<Image<float>(const FrequencyGrid&)>;

/// A pattern that more frequencies make than can be computed.
struct PatternLimit : LimitError {
    using LimitError::LimitError;
};

/// How a sensor samples one wavelength's pattern.
struct PixelLight {
    double pixel = 0;  ///< width of a pixel, in the units of the power's frequencies
    Vec3d colour;      ///< of unit energy
};

/// Pixels are the squares of width pixel around (x - radius_px) pixel, (y - radius_px) pixel, 2 radius_px + 1
/// to a side. Returns for each the sum over the lights of colour times the integral of the power over its
/// square. The power is sampled at whole multiples of `cell` and taken as constant over the square cell
/// around each sample: cell <= 1 / (2 extent of the aperture) loses nothing in squares of several cells.
Image<Vec3d> integrate_over_pixels(const PowerSource& power, double cell, int radius_px,
                                   const std::vector<PixelLight>& lights, const Exec& exec);

/// Frequencies that this asks of the source: those of all bands, and the first band's. Throws PatternLimit,
/// as the integration does.
struct PixelIntegralWork {
    std::int64_t frequencies = 0;
    FrequencyGrid band;
};
PixelIntegralWork pixel_integral_work(double cell, int radius_px, const std::vector<PixelLight>& lights);

/// Milliseconds on one thread, the source's own time apart; measured on a 2-core AVX-512 Xeon.
double pixel_integral_cost_ms(const PixelIntegralWork& work, int radius_px, std::size_t lights);

}  // namespace obscura
