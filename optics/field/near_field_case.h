#pragma once
// What every strategy of the near field reads, and which part of the plane it must compute.

#include "core/image.h"
#include "optics/field/aperture.h"
#include "optics/field/mask_changes.h"
#include "optics/field/near_field_axis.h"
#include "optics/field/plane_grid.h"

namespace obscura {

/// `turns` is pitch^2 / (2 lambda z): half the phase, in turns, that a texel off the axis adds.
struct NearFieldCase {
    ImageView<const float> mask;
    PlaneGrid grid;
    double turns = 0;
    LineChanges changes;  ///< of the mask's rows
    MaskSymmetry symmetry;
    PlaneAxis horizontal() const { return {mask.width, grid.width, grid.first_x, grid.step}; }
    PlaneAxis vertical() const { return {mask.height, grid.height, grid.first_y, grid.step}; }
};

/// What of the plane must be computed, from its upper left corner on: half an axis along which mask and plane
/// both are their own mirror images, the whole of any other.
struct PlanePart {
    int columns = 0, rows = 0;
};
PlanePart part_to_compute(const NearFieldCase& c);

}  // namespace obscura
