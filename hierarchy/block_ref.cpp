// Intervals of a block, texel by texel: crossings, sorted, counted.

#include <algorithm>

#include "hierarchy/block.h"
#include "raster/coverage.h"
#include "raster/intervals.h"

namespace obscura::ref {

void block_intervals(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                     std::int32_t x0, std::int32_t y0, bool static_receivers, float* entry,
                     float* exit) noexcept {
    const Receivers receivers = static_receivers ? Receivers::static_only : Receivers::any;
    for (int i = 0; i < block_texels; ++i) {
        const std::int32_t x = x0 + block_column(i), y = y0 + block_row(i);
        LayerCrossing crossing[block_facets];
        std::size_t found = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const TriangleRecord* t = &records[list[k]];
            if (!covers_outline(t, x, y)) continue;
            crossing[found++] = {depth_at(*t, x + 0.5, y + 0.5), t->crossing, t->triangle};
        }
        if (found == 0) {
            entry[i] = exit[i] = 1.0f;
            continue;
        }
        std::sort(crossing, crossing + found, comes_before);
        const DepthInterval interval = interval_of({crossing, found}, receivers);
        entry[i] = interval.entry;
        exit[i] = interval.exit;
    }
}

}  // namespace obscura::ref
