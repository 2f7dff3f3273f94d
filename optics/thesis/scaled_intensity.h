#pragma once
// A near field's colours by the thesis's heuristic: other wavelengths as the reference's, scaled.

#include "core/image.h"
#include "optics/field/plane_grid.h"

namespace obscura {

/// AN APPROXIMATION, not physics (thesis, section 3.4.5 and figure 3.7b): the intensity at another wavelength
/// as that of the reference wavelength looked up at 1 + 0.05 (1 - rho) times the distance from the axis, rho
/// = reference wavelength / wavelength. Rings of longer wavelengths stand farther inside the shadow's edge,
/// as they should, though by how much depends on the distance in truth and not here; bilinear, and the
/// border's value beyond the plane.
Image<float> scaled_intensity(ImageView<const float> reference, const PlaneGrid& grid, double rho);

}  // namespace obscura
