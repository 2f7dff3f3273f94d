#include "optics/field/near_field_case.h"

#include <cmath>

namespace obscura {
namespace {

/// True when pixels mirror onto pixels.
bool is_symmetric(const PlaneAxis& axis) {
    const double extent = (axis.pixels - 1) * axis.step;
    return std::fabs(2 * axis.first + extent) <= 1e-13 * (extent + axis.texels);
}

}  // namespace

PlanePart part_to_compute(const NearFieldCase& c) {
    PlanePart part{c.grid.width, c.grid.height};
    if (c.symmetry.left_right && is_symmetric(c.horizontal())) part.columns = (part.columns + 1) / 2;
    if (c.symmetry.top_bottom && is_symmetric(c.vertical())) part.rows = (part.rows + 1) / 2;
    return part;
}

}  // namespace obscura
