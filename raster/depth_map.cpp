#include "raster/depth_map.h"

#include <algorithm>

#include "core/parallel.h"
#include "raster/depth_tile.h"

namespace obscura {
namespace {

constexpr int tile_side = 64;

}  // namespace

void depth_map(const Mesh& mesh, const View& view, const SetupParams& params, const Exec& exec,
               RasterScratch& scratch, ImageView<float> out) {
    CHECK(out.width == view.width && out.height == view.height);
    SetupParams setup_params = params;
    setup_params.pair_faces = true;
    setup_triangles(mesh, view, setup_params, exec, scratch.setup);
    bin_records(scratch.setup, view.width, view.height, tile_side, exec, scratch.bins);
    const TileBins& bins = scratch.bins;
    parallel_for(static_cast<std::size_t>(bins.rows), exec, [&](std::size_t tile_row) {
        // Work in a tile that stays in the cache, then copy it out.
        alignas(64) float depth[tile_side * tile_side];
        for (int column = 0; column < bins.columns; ++column) {
            const auto row = static_cast<int>(tile_row);
            const TileRect tile{column * tile_side, row * tile_side, tile_side, tile_side};
            const auto list = bins.list(column, row);
            std::fill(std::begin(depth), std::end(depth), view.max_depth);
            OBSCURA_DISPATCH(exec.isa, depth_tile, scratch.setup.records.data(), list.data(), list.size(),
                             tile, depth);
            const int width = std::min(tile_side, view.width - tile.x0);
            const int height = std::min(tile_side, view.height - tile.y0);
            for (int y = 0; y < height; ++y) {
                copy_streaming(&out(tile.x0, tile.y0 + y), depth + y * tile_side,
                               static_cast<std::size_t>(width) * sizeof(float));
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
