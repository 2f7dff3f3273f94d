#pragma once
// Whether a camera can see the back of a solid: if not, its back faces need not be rasterized.

#include <vector>

#include "core/mesh.h"
#include "core/scene.h"
#include "raster/view.h"

namespace obscura {

/// The closed components of a mesh.
struct Solids {
    bool outward = false;        ///< all of them enclose a positive volume: none is inside out
    std::vector<Bounds> bounds;  ///< one each
};
Solids solids_of(const Mesh& mesh);

/// True when no ray of the camera can meet a solid's back before its front: no solid is inside out, and the
/// camera's near rectangle lies outside the bounds of each. Asked of boxes, so the answer may be a false
/// "no", never a false "yes".
bool sees_no_exits(const Solids& solids, const Camera& camera, int width, int height);

}  // namespace obscura
