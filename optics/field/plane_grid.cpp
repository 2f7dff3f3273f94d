#include "optics/field/plane_grid.h"

#include "core/error.h"

namespace obscura {

PlaneGrid centred_plane(int size, double extent_texels) {
    CHECK(size > 0 && extent_texels > 0);
    const double step = extent_texels / size;
    return {size, size, -0.5 * extent_texels + 0.5 * step, -0.5 * extent_texels + 0.5 * step, step};
}

}  // namespace obscura
