#pragma once
// Dense shadow maps: one stored depth per texel, the middle of its depth interval.
//
// L. Williams, "Casting Curved Shadows on Curved Surfaces", SIGGRAPH 1978, with the depth of A. Woo, "The
// Shadow Depth Map Revisited", Graphics Gems III, 1992: half way between where light enters a solid and where
// it would leave it, so that neither its lit nor its dark side needs a bias.

#include <cstdint>
#include <vector>

#include "core/buffer.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/scene.h"
#include "raster/interval_map.h"
#include "raster/view.h"

namespace obscura {

/// One view for directional lights and spots, six for points (cube_face() says which sees a direction).
struct ShadowMap {
    std::vector<LightView> views;
    std::vector<Raster<float>> stored;  ///< as views: depth of each texel, 1 where nothing is
};

/// Views that a light's map needs: for directional lights and the sun fitted to `bounds` (of casters and
/// receivers), for the others to the light's own range.
std::vector<LightView> shadow_views(const Light& light, const Bounds& bounds);

/// Memory of the map that build_shadow_map() would make, bytes.
std::int64_t dense_map_bytes(const Light& light);

/// Renders the map of `light` tile by tile; only stored depths are kept. `map` may hold an earlier map: its
/// memory is used again.
void build_shadow_map(const Mesh& mesh, const Light& light, const Bounds& bounds, const Exec& exec,
                      RasterScratch& scratch, ShadowMap& map);

/// Metres that a texel of the view spans: everywhere (orthographic), or at distance 1 (perspective).
double texel_size_m(const LightView& view);

}  // namespace obscura
