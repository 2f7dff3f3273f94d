#pragma once
// Near fields in colour: exactly, wavelength by wavelength, or by the thesis's heuristic from one of them.

#include <functional>

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "optics/near_field.h"
#include "optics/spectrum.h"

namespace obscura {

/// How the wavelengths of a near field are come by.
enum class NearFieldColour {
    exact,   ///< a near field for every one: the far field's scaling does not hold (figure 3.7c)
    scaled,  ///< one near field, the others scaled from it (optics/thesis/scaled_intensity.h)
};
const char* near_field_colour_name(NearFieldColour how);

/// Reference wavelength of `scaled`: the geometric mean of 400 and 700 nm, as in the thesis.
constexpr double near_field_reference_nm = 529.15;

/// Linear sRGB over the plane (channels may be negative: into_gamut()), 1 in luminance where nothing stands
/// in the way; `count` wavelengths of the light, params.wavelength_m is not read.
/// `progress` hears in this thread, after every wavelength, which share is done.
Image<Vec3f> near_field_colour(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                               const LightSpectrum& light, int count, NearFieldColour how, const Exec& exec,
                               const std::function<void(double)>& progress = {});

}  // namespace obscura
