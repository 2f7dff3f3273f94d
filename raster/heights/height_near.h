#pragma once
// Rays that end after some lines, fast.

#include "raster/heights/height_field.h"
#include "raster/heights/height_sun.h"
#include "raster/heights/shadow_bits.h"

namespace obscura {

/// The samples of `asked` that ground at most `last_line` lines away hides from the sun: march_shadows(field,
/// sun, {0, last_line}), bit for bit, where a bit of `asked` is set, and 0 elsewhere.
ShadowBits near_shadows(const HeightField& field, const HeightSun& sun, int last_line,
                        const ShadowBits& asked);

}  // namespace obscura
