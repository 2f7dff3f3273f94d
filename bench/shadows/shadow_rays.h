#pragma once
// Shadow rays of Embree as a method of the shadow bench. Built only with Embree (OBSCURA_HAS_EMBREE).

#include "bench/harness/contestant.h"
#include "bench/shadows/visible_points.h"
#include "core/mesh.h"

namespace obscura {

/// Jobs "packets of 16 rays" (4 x 4 pixels, coherent flag) and "single rays": is light blocked at each pixel
/// that faces the light in unit direction `to_light`? Default build quality, no robust flag: what is fastest.
/// Rays start `off` of the scene's extent off the surface, along its normal. `points` and `mesh` outlive the
/// session; results go into `shown`, one byte per pixel.
Session open_shadow_rays(const Mesh& mesh, const VisiblePoints& points, Vec3d to_light,
                         std::vector<std::uint8_t>& shown, const Exec& exec, double off = 1e-4);

}  // namespace obscura
