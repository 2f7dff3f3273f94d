#pragma once
// The runs method away from natural grids: any window, any step.

#include "core/image.h"
#include "core/isa.h"
#include "optics/far_field.h"
#include "optics/field.h"

namespace obscura {

/// F of a mask over any grid; see optics/far_field_methods.h.
void far_field_chirp(ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target,
                     const Exec& exec);

/// log2 of the transforms it would use: the cheapest cut of the grid's rows into tiles.
int chirp_log2_length(int mask_height, int grid_height);

}  // namespace obscura
