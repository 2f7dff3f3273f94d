#pragma once
// Dense shadow maps: one stored depth per texel, the middle of its depth interval.
//
// L. Williams, "Casting Curved Shadows on Curved Surfaces", SIGGRAPH 1978, with the depth of A. Woo, "The
// Shadow Depth Map Revisited", Graphics Gems III, 1992: half way between where light enters a solid and where
// it would leave it, so that neither its lit nor its dark side needs a bias.

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/buffer.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/scene.h"
#include "raster/interval_map.h"
#include "raster/view.h"

namespace obscura {

/// Depths of a square map in blocks of 4 x 4 texels, one cache line each: neighbours in a picture lie in any
/// direction on the map, and find their texels in few lines. `size` is a multiple of 4.
struct StoredDepths {
    int size = 0;
    Buffer<float> depth;

    std::size_t index(int x, int y) const {
        const auto block = static_cast<std::size_t>(y / 4) * static_cast<std::size_t>(size / 4) +
                           static_cast<std::size_t>(x / 4);
        return block * 16 + static_cast<std::size_t>((y % 4) * 4 + x % 4);
    }
    float at(int x, int y) const { return depth[index(x, y)]; }
};

/// One view for directional lights and spots, six for points (cube_face() says which sees a direction).
struct ShadowMap {
    std::vector<LightView> views;
    std::vector<StoredDepths> stored;  ///< as views: depth of each texel, 1 where nothing is
};

/// What a light's views depend on beside the light.
struct ShadowViewParams {
    int resolution = 1024;  ///< texels per side
    int filter_px = 3;      ///< side of the kernel that reads the map: lamps' views are wider by its reach
};

/// Views that a light's map needs: of parallel light fitted to `bounds` (of casters and receivers), of others
/// to the light's own range.
std::vector<LightView> shadow_views(const Light& light, const ShadowViewParams& params, const Bounds& bounds);

/// Views of the same light for a map that is not dense: of parallel light fitted to `casters`, as
/// caster_box() finds it.
std::vector<LightView> fitted_shadow_views(const Light& light, const ShadowViewParams& params,
                                           const Bounds& casters);

/// Memory of a dense map of such a light, bytes.
std::int64_t dense_map_bytes(LightKind kind, int resolution);

/// Renders the map of a light with these views tile by tile; only stored depths are kept. `map` may hold an
/// earlier map: its memory is used again.
/// False when `cancel` was set meanwhile (asked for every row of tiles): the map is then without views.
bool build_shadow_map(const Mesh& mesh, std::vector<LightView> views, Receivers receivers, const Exec& exec,
                      RasterScratch& scratch, ShadowMap& map, const std::atomic<bool>* cancel = nullptr);

/// Metres that a texel of the view spans, the longer way: everywhere (orthographic), or at distance 1
/// (perspective).
double texel_size_m(const LightView& view);

}  // namespace obscura
