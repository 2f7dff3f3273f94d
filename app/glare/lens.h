#pragma once
// The scene's lens in the terms of optics/: its aperture, and what its picture of a point of light needs.

#include "app/scene/scene.h"
#include "optics/far_field.h"
#include "optics/field/aperture.h"
#include "optics/glare.h"
#include "optics/psf.h"

namespace obscura {

/// The mask that spans the entrance pupil. Throws InputError when it is closed.
Aperture lens_aperture(const OpticsSettings& optics);

/// Diameter of the entrance pupil, metres.
double pupil_m(const OpticsSettings& optics);
/// Side of a pixel on the sensor, metres.
double pixel_m(const OpticsSettings& optics, const RenderSettings& render);

PsfParams psf_params(const OpticsSettings& optics, const RenderSettings& render);

/// Clip level in radiance before exposure, and how to spread.
GlareParams glare_params(const OpticsSettings& optics, const RenderSettings& render);

/// Side of the kernel, pixels.
int kernel_side(const OpticsSettings& optics);

}  // namespace obscura
