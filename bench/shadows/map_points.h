#pragma once
// Where the pixels of a picture fall on a shadow map: the points of bare lookups.

#include <cstdint>
#include <span>
#include <vector>

#include "bench/shadows/visible_points.h"
#include "core/scene.h"
#include "filters/shadow_lookup.h"
#include "hierarchy/codes/query.h"

namespace obscura {

/// Texel and tested depth of every pixel that is looked up, as a lookup with a kernel of one texel has them;
/// sixteen points that stand together are 4 x 4 pixels, unless some of those are not looked up.
struct MapPointList {
    std::vector<std::int32_t> x, y;
    std::vector<float> depth;
    std::vector<std::uint32_t> pixel;  ///< index into the picture's rows

    MapPoints points(std::size_t first, std::size_t count) const {
        return {x.data() + first, y.data() + first, depth.data() + first, count};
    }
};

/// Of all pixels; `light`: of pcf_light().
MapPointList map_points(const VisiblePoints& points, const PcfLight& light);

/// What is stored where a sample falls: texel and the depth compared there; nothing where there is no lookup.
struct TestedTexel {
    bool looked_up = false;
    std::int32_t x = 0, y = 0;
    float depth = 0;
};
TestedTexel tested_texel(const SurfaceBlock& surface, const PcfLight& light, int at);

}  // namespace obscura
