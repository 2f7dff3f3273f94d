#pragma once
// Patterns of lamps that the scene hides from parts of the lens (thesis, section 3.4.4).

#include "app/glare/source_kernels.h"

namespace obscura {

/// Held of each bright pixel of a lamp while kernels are chosen, lists growing included.
constexpr std::int64_t bytes_per_lamp_pixel = 160;

/// Every bright pixel's own visible pupil is rasterized at low resolution and classed by how much of it is
/// hidden and where the hidden part lies; a class takes the pattern of its most typical pixel, at the mask's
/// full resolution, which is added to `to` and chosen by its members.
void add_hidden_lamps(const Scene& scene, const LitPicture& picture, double clip, const Aperture& aperture,
                      const Exec& exec, SourceKernels& to);

}  // namespace obscura
