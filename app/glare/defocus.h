#pragma once
// Patterns of points of light that are out of focus: near fields of the lens's aperture.

#include "app/glare/source_kernels.h"

namespace obscura {

/// Sources by at most focus_steps steps of vergence: each step's kernel is added to `to` and chosen by its
/// pixels. Those that are blurred by less than half a pixel stay with the lens in focus.
void add_defocus(const Scene& scene, const LitPicture& picture, double clip, const Aperture& aperture,
                 const Exec& exec, SourceKernels& to);

/// The near field of the aperture for a point of light out of focus: a kernel of side 2 radius + 1, channels
/// of sum 1. `vergence_per_m`: 1 / distance - 1 / focus distance; positive for points nearer than the focus,
/// which show the aperture upside down.
Image<Vec3f> defocus_kernel(const Aperture& aperture, const OpticsSettings& optics,
                            const RenderSettings& render, double vergence_per_m, const Exec& exec);

}  // namespace obscura
