#pragma once
// Near fields in colour: exactly, wavelength by wavelength, or by the thesis's heuristic from one of them.

#include <functional>

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "optics/near_field.h"
#include "optics/spectrum.h"

namespace obscura {

/// AN APPROXIMATION, not physics (thesis, section 3.4.5 and figure 3.7b): the intensity at another wavelength
/// as that of the reference wavelength looked up at 1 + 0.05 (1 - rho) times the distance from the axis, rho
/// = reference wavelength / wavelength. Rings of longer wavelengths stand farther inside the shadow's edge,
/// as they should, though by how much depends on the distance in truth and not here; bilinear, and the
/// border's value beyond the plane.
Image<float> scaled_intensity(ImageView<const float> reference, const PlaneGrid& grid, double rho);

/// How the wavelengths of a near field are come by.
enum class NearFieldColour {
    exact,   ///< a near field for every one: the far field's scaling does not hold (figure 3.7c)
    scaled,  ///< one near field, then scaled_intensity()
};

/// Reference wavelength of `scaled`: the geometric mean of 400 and 700 nm, as in the thesis.
constexpr double near_field_reference_nm = 529.15;

/// Linear sRGB over the plane (channels may be negative: into_gamut()), 1 in luminance where nothing stands
/// in the way; `count` wavelengths of the light, params.wavelength_m is not read.
/// `progress` hears in this thread, after every wavelength, which share is done.
Image<Vec3f> near_field_colour(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                               const LightSpectrum& light, int count, NearFieldColour how, const Exec& exec,
                               const std::function<void(double)>& progress = {});

}  // namespace obscura
