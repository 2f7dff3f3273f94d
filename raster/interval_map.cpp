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
    SetupParams setup_params;
    setup_params.only_casters = params.only_casters;
    setup_params.pair_faces = true;
    setup_params.region = region_of(view, params.region);
    CHECK(out.width == setup_params.region.width && out.height == setup_params.region.height);
    setup_triangles(mesh, view, setup_params, exec, scratch.setup);
    bin_records(scratch.setup, setup_params.region, layer_tile_side, exec, scratch.bins);
    const TileBins& bins = scratch.bins;
    parallel_for(static_cast<std::size_t>(bins.rows), exec, [&](std::size_t row) {
        IntervalTiler tiler;
        alignas(64) DepthInterval result[layer_tile_texels];
        for (int column = 0; column < bins.columns; ++column) {
            const std::size_t i = bins.index(column, static_cast<int>(row));
            tiler.run(scratch.setup, bins.list(i), bins.rect(i), params.receivers, exec.isa, result);
            const Region inside = bins.inside(i);
            for (int y = 0; y < inside.height; ++y) {
                copy_streaming(&out(inside.x0 - bins.region.x0, inside.y0 - bins.region.y0 + y),
                               result + y * layer_tile_side,
                               static_cast<std::size_t>(inside.width) * sizeof(DepthInterval));
            }
        }
        finish_streaming();
    });
}

Image<DepthInterval> interval_map(const Mesh& mesh, const LightView& view, const IntervalParams& params,
                                  const Exec& exec) {
    RasterScratch scratch;
    const Region region = region_of(view, params.region);
    Image<DepthInterval> out(region.width, region.height);
    interval_map(mesh, view, params, exec, scratch, out.view());
    return out;
}

}  // namespace obscura
