#pragma once
// Depth intervals of maps that are too large to be held whole.

#include <functional>

#include "core/image.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/types.h"

namespace obscura {

/// Calls `take` with the intervals of all rows of a view's map, `rows` of them at a time, top down: first row
/// and picture. Receivers any.
void for_each_band(const Mesh& mesh, const LightView& view, int rows, const Exec& exec,
                   const std::function<void(int y, ImageView<const DepthInterval> band)>& take);

}  // namespace obscura
