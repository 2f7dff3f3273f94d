#include "raster/interval_map.h"

#include <algorithm>

#include "core/parallel.h"

namespace obscura {

IntervalTiler::IntervalTiler()
    : keys_(static_cast<std::size_t>(layers_in_place * layer_tile_texels)),
      filled_(layer_tile_texels / 16),
      spilled_(1024) {}

void IntervalTiler::run(const TriangleSetup& setup, std::span<const std::uint32_t> list, const TileRect& tile,
                        Receivers receivers, Isa isa, DepthInterval* out) {
    const auto texels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
    if (list.empty()) {
        std::fill_n(out, texels, DepthInterval{});
        return;
    }
    stack_.keys = keys_.data();
    stack_.filled = filled_.data();
    do {
        // Twice at most: the first run says how much room the spilled layers need.
        if (stack_.spill_count > spilled_.size()) spilled_.reset(stack_.spill_count);
        stack_.spilled = spilled_.data();
        stack_.spill_capacity = spilled_.size();
        OBSCURA_DISPATCH(isa, layer_tile, setup.records.data(), list.data(), list.size(), tile, stack_);
    } while (stack_.spill_count > stack_.spill_capacity);
    OBSCURA_DISPATCH(isa, interval_tile, stack_, tile, receivers == Receivers::static_only, out);
    decide_rest(tile, receivers, out);
}

/// Texels that eight layers did not decide: the eight in place, then whatever spilled, in order.
void IntervalTiler::decide_rest(const TileRect& tile, Receivers receivers, DepthInterval* out) {
    const std::int32_t rows = tile.width * tile.height / 16;
    if (std::find(filled_.begin(), filled_.begin() + rows, layers_in_place) == filled_.begin() + rows) return;
    SpilledLayer* const begin = spilled_.data();
    SpilledLayer* const end = begin + stack_.spill_count;
    std::sort(begin, end, [](const SpilledLayer& p, const SpilledLayer& q) {
        return p.texel != q.texel ? p.texel < q.texel : p.key < q.key;
    });
    std::vector<LayerCrossing> crossings;
    for (std::int32_t texel = 0; texel < tile.width * tile.height; ++texel) {
        if (out[texel].entry != undecided_entry) continue;
        crossings.clear();
        for (int l = 0; l < layers_in_place; ++l) {
            const LayerKey key = keys_[static_cast<std::size_t>(layer_place(texel, l))];
            crossings.push_back({layer_depth(key), layer_crossing(key), 0});
        }
        const SpilledLayer* s = std::lower_bound(
            begin, end, texel, [](const SpilledLayer& p, std::int32_t t) { return p.texel < t; });
        for (; s != end && s->texel == texel; ++s) {
            crossings.push_back({layer_depth(s->key), layer_crossing(s->key), 0});
        }
        out[texel] = interval_of(crossings, receivers);
    }
}

void interval_map(const Mesh& mesh, const LightView& view, const IntervalParams& params, const Exec& exec,
                  RasterScratch& scratch, ImageView<DepthInterval> out) {
    CHECK(out.width == view.width && out.height == view.height);
    SetupParams setup_params;
    setup_params.only_casters = params.only_casters;
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
