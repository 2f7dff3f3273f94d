#include "raster/depth_map.h"

#include <algorithm>

#include "core/parallel.h"
#include "raster/depth_tile.h"

namespace obscura {
void depth_map(const Mesh& mesh, const View& view, const SetupParams& params, const Exec& exec,
               RasterScratch& scratch, ImageView<float> out) {
    SetupParams setup_params = params;
    setup_params.pair_faces = true;
    setup_params.region = region_of(view, params.region);
    CHECK(out.width == setup_params.region.width && out.height == setup_params.region.height);
    setup_triangles(mesh, view, setup_params, exec, scratch.setup);
    bin_records(scratch.setup, setup_params.region, depth_tile_side, exec, scratch.bins);
    const TileBins& bins = scratch.bins;
    parallel_for(static_cast<std::size_t>(bins.rows), exec, [&](std::size_t row) {
        // Work in a tile that stays in the cache, then copy it out.
        alignas(64) float depth[depth_tile_side * depth_tile_side];
        for (int column = 0; column < bins.columns; ++column) {
            const std::size_t i = bins.index(column, static_cast<int>(row));
            const auto list = bins.list(i);
            std::fill(std::begin(depth), std::end(depth), view.max_depth);
            OBSCURA_DISPATCH(exec.isa, depth_tile, scratch.setup.records.data(), list.data(), list.size(),
                             bins.rect(i), depth);
            const Region inside = bins.inside(i);
            for (int y = 0; y < inside.height; ++y) {
                copy_streaming(&out(inside.x0 - bins.region.x0, inside.y0 - bins.region.y0 + y),
                               depth + y * depth_tile_side,
                               static_cast<std::size_t>(inside.width) * sizeof(float));
            }
        }
        finish_streaming();
    });
}

Image<float> depth_map(const Mesh& mesh, const View& view, const Exec& exec) {
    RasterScratch scratch;
    Image<float> out(view.width, view.height);
    depth_map(mesh, view, {}, exec, scratch, out.view());
    return out;
}

}  // namespace obscura
