#pragma once
// Apertures as they are: smeared, dusty, scratched, behind eyelashes, partly hidden.

#include "core/image.h"
#include "optics/field/aperture.h"
#include "optics/lens_dirt.h"

namespace obscura {

/// True when there is anything at all.
bool has_dirt(const LensDirt& dirt);

/// What has an edge: scratches, eyelashes, the occluder and hard dust as loops that close, over an open
/// square (or the housing's opening), in texels of a mask this large. Throws InputError as below.
Outline dirt_outline(const LensDirt& dirt, int width, int height);

/// Amplitude that passes each texel of a mask this large, in [0, 1]. Dirt is placed in shares of the mask's
/// longer side, around its middle: of the same look at every size. Scratches, eyelashes, the occluder and
/// hard dust have exact coverage, also where they overlap each other. Throws InputError when a number is out
/// of its range.
Image<float> dirt_transmission(const LensDirt& dirt, int width, int height);

/// Multiplies the mask by that. The outline, which is no longer the opening's, is dropped (when there is any
/// dirt).
void add_dirt(const LensDirt& dirt, Aperture& aperture);

/// Any mask moved over the aperture, its middle (dx, dy) texels right and below the aperture's middle; its
/// texels are as large as the aperture's. housing: light passes where `occluder` is open, and not beyond its
/// border; disc: where it is closed, and beyond. Fractions of texels shift by areas. Texels where both have
/// edges take the product of the two coverages. Drops the outline.
void add_occluder(ImageView<const float> occluder, double dx, double dy, Occluder kind, Aperture& aperture);

}  // namespace obscura
