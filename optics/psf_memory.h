#pragma once
// What patterns and glare hold while they are made, known before.

#include <cstdint>

#include "optics/glare.h"
#include "optics/pixel_integrals.h"
#include "optics/psf.h"

namespace obscura {

/// Bytes that far_field_psf() holds at once, the aperture and the kernel returned included; what transforms
/// work with (a few MiB) is not. Nothing is rasterized to find out. Throws as far_field_psf() does.
std::int64_t far_field_psf_bytes(const Aperture& aperture, const PsfParams& params);

/// Of these: what integrate_over_pixels() holds beside one band's power.
std::int64_t pixel_integral_bytes(const PixelIntegralWork& work, int radius_px, std::size_t lights);

/// Bytes that spread_glare() holds beside picture and kernels: `sources` pixels glare, anywhere in a picture
/// of width x height. A bound.
std::int64_t spread_glare_bytes(std::int64_t sources, int width, int height, int kernel_side,
                                const GlareParams& params);

}  // namespace obscura
