#pragma once
// The complete depth-ordered list of crossings of every ray of a region.

#include <cstdint>
#include <span>
#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "core/types.h"
#include "raster/intervals.h"

namespace obscura {

/// Crossings per texel of a region, each list in the order of comes_before().
struct Layers {
    Region region;
    std::vector<std::size_t> first;  ///< width * height + 1 offsets into `crossings`
    std::vector<LayerCrossing> crossings;

    /// x, y in the view's texels.
    std::span<const LayerCrossing> at(int x, int y) const {
        const auto i = static_cast<std::size_t>(y - region.y0) * static_cast<std::size_t>(region.width) +
                       static_cast<std::size_t>(x - region.x0);
        return {crossings.data() + first[i], first[i + 1] - first[i]};
    }
};

/// Every crossing of every texel of `region`, which must lie inside the view. No cap on their number; memory
/// follows the region, not the view.
Layers layers_of(const Mesh& mesh, const LightView& view, const Region& region, const Exec& exec);

}  // namespace obscura
