#include "raster/layers.h"

#include <algorithm>

#include "core/parallel.h"
#include "raster/depth_map.h"
#include "raster/layer_memory.h"

namespace obscura {
namespace {

/// Crossings of one tile, texel by texel.
struct TileLayers {
    std::vector<std::size_t> first;  ///< per texel and one more
    std::vector<LayerCrossing> crossings;
};

TileLayers collect(const LayerStack& stack, const TileRect& tile) {
    TileLayers tile_layers;
    for (std::int32_t i = 0; i < tile.width * tile.height; ++i) {
        tile_layers.first.push_back(tile_layers.crossings.size());
        for (std::int32_t l = 0; l < stack.filled[i / 16]; ++l) {
            const std::int32_t at = stack.place(i / 16, l) + i % 16;
            if (stack.keys[at] == no_layer) break;
            tile_layers.crossings.push_back({layer_depth(stack.keys[at]), layer_crossing(stack.keys[at]),
                                             static_cast<std::uint32_t>(stack.triangles[at])});
        }
    }
    tile_layers.first.push_back(tile_layers.crossings.size());
    return tile_layers;
}

TileLayers layers_of_tile(const RasterScratch& scratch, std::span<const std::uint32_t> list,
                          const TileRect& tile, Isa isa) {
    LayerMemory memory(true);
    const LayerStack& stack = memory.run([&](LayerStack& s) {
        OBSCURA_DISPATCH(isa, layer_tile_with_triangles, scratch.setup.records.data(), list.data(),
                         list.size(), tile, s);
    });
    return collect(stack, tile);
}

}  // namespace

Layers layers_of(const Mesh& mesh, const LightView& view, const Region& region, const Exec& exec) {
    RasterScratch scratch;
    SetupParams params;
    params.region = region;
    setup_triangles(mesh, view, params, exec, scratch.setup);
    bin_records(scratch.setup, region, layer_tile_side, exec, scratch.bins);
    const TileBins& bins = scratch.bins;
    std::vector<TileLayers> tiles(bins.tiles());
    parallel_for(tiles.size(), exec, [&](std::size_t i) {
        tiles[i] = layers_of_tile(scratch, bins.list(i), bins.rect(i), exec.isa);
    });

    // From tiles to rows of the region.
    Layers layers;
    layers.region = region;
    layers.first.push_back(0);
    for (int y = 0; y < region.height; ++y) {
        for (int x = 0; x < region.width; ++x) {
            const TileLayers& tile = tiles[bins.index(x / layer_tile_side, y / layer_tile_side)];
            const int column = x % layer_tile_side, row = y % layer_tile_side;
            const std::size_t texel =
                static_cast<std::size_t>(row) * layer_tile_side + static_cast<std::size_t>(column);
            const LayerCrossing* all = tile.crossings.data();
            layers.crossings.insert(layers.crossings.end(), all + tile.first[texel],
                                    all + tile.first[texel + 1]);
            layers.first.push_back(layers.crossings.size());
        }
    }
    return layers;
}

}  // namespace obscura
