#pragma once
// Near fields as lesson 11 shows them: by Fresnel number instead of distance.

#include "core/isa.h"
#include "optics/aperture_shapes.h"
#include "optics/near_field.h"

namespace obscura {

/// A shape that touches all sides of a mask of `size` texels, so that half the mask is its radius a.
Aperture full_aperture(ApertureKind kind, int size);

/// The distance at which a^2 / (lambda z) is `fresnel`, at 550 nm.
NearFieldParams at_fresnel_number(const Aperture& aperture, double fresnel);

/// |U|^2 on the axis behind the opening, and behind a disc of its shape in free space, which by Babinet's
/// principle is |1 - U|^2.
struct OnAxis {
    double opening = 0, disc = 0;
};
OnAxis on_axis(const Aperture& aperture, double fresnel, const Exec& exec);

/// |1 - U|^2 over a plane.
Image<float> behind_disc(const Aperture& aperture, const PlaneGrid& plane, double fresnel, const Exec& exec);

/// What the far field alone would give: |F|^2 at x' / (lambda z), over (lambda z)^2.
Image<float> far_intensity(const Aperture& aperture, const PlaneGrid& plane, double fresnel,
                           const Exec& exec);

/// Largest difference of two pictures, as a share of the second one's largest value.
double share_of_peak(const Image<float>& a, const Image<float>& b);

}  // namespace obscura
