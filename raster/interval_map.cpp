#include "raster/interval_map.h"

#include <algorithm>

#include "core/parallel.h"

namespace obscura {

IntervalTiler::IntervalTiler() : layers_(false) {}

void IntervalTiler::run(const TriangleSetup& setup, std::span<const std::uint32_t> list, const TileRect& tile,
                        Receivers receivers, Isa isa, DepthInterval* out) {
    if (list.empty()) {
        std::fill_n(out, tile.width * tile.height, DepthInterval{});
        return;
    }
    const LayerStack& stack = layers_.run([&](LayerStack& s) {
        OBSCURA_DISPATCH(isa, layer_tile, setup.records.data(), list.data(), list.size(), tile, s);
    });
    OBSCURA_DISPATCH(isa, interval_tile, stack, tile, receivers == Receivers::static_only, out);
}

void interval_map(const Mesh& mesh, const LightView& view, const IntervalParams& params, const Exec& exec,
                  RasterScratch& scratch, ImageView<DepthInterval> out) {
    CHECK(out.width == view.width && out.height == view.height);
    SetupParams setup_params;
    setup_params.only_casters = params.only_casters;
    setup_params.pair_faces = true;
    setup_triangles(mesh, view, setup_params, exec, scratch.setup);
    bin_records(scratch.setup, view.width, view.height, layer_tile_side, exec, scratch.bins);
    const TileBins& bins = scratch.bins;
    parallel_for(static_cast<std::size_t>(bins.rows), exec, [&](std::size_t tile_row) {
        IntervalTiler tiler;
        alignas(64) DepthInterval result[layer_tile_texels];
        for (int column = 0; column < bins.columns; ++column) {
            const auto row = static_cast<int>(tile_row);
            const TileRect tile{column * layer_tile_side, row * layer_tile_side, layer_tile_side,
                                layer_tile_side};
            tiler.run(scratch.setup, bins.list(column, row), tile, params.receivers, exec.isa, result);
            const int width = std::min(layer_tile_side, view.width - tile.x0);
            const int height = std::min(layer_tile_side, view.height - tile.y0);
            for (int y = 0; y < height; ++y) {
                copy_streaming(&out(tile.x0, tile.y0 + y), result + y * layer_tile_side,
                               static_cast<std::size_t>(width) * sizeof(DepthInterval));
            }
        }
        finish_streaming();
    });
}

Image<DepthInterval> interval_map(const Mesh& mesh, const LightView& view, const IntervalParams& params,
                                  const Exec& exec) {
    RasterScratch scratch;
    Image<DepthInterval> out(view.width, view.height);
    interval_map(mesh, view, params, exec, scratch, out.view());
    return out;
}

}  // namespace obscura
