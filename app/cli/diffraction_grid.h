#pragma once
// The frequencies or positions that the flags of `obscura diffraction` ask for.

#include "app/cli/diffraction_command.h"

namespace obscura {

/// Of the mask, in texels.
double longer_side(const Aperture& aperture);

FrequencyGrid far_grid(const DiffractionOptions& options, const Aperture& aperture);
PlaneGrid near_grid(const DiffractionOptions& options, const Aperture& aperture);

/// Throws InputError when the method that was asked for cannot serve that grid, with a --zoom that it could.
void check_served(const DiffractionOptions& options, const Aperture& aperture);

}  // namespace obscura
