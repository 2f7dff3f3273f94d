#include "bench/shadows/frame_samples.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "app/frame/exact_tile.h"
#include "app/frame/render_frame.h"
#include "bench/shadows/visible_points.h"
#include "core/error.h"
#include "core/parallel.h"
#include "raster/exact/exact_shadow.h"

namespace obscura {
namespace {

/// A block's samples, each the k-th of its pixel, from first_row of its tile on; `first`: the tile's first
/// point.
void keep(const SurfaceBlock& block, const Scene& scene, std::size_t first, int k, int first_row,
          FrameSamples& samples) {
    double px[block_samples], py[block_samples], pz[block_samples];
    std::uint32_t face[block_samples];
    exact_positions(block, scene.mesh, scene.camera.eye, px, py, pz, face);
    for (int i = 0; i < block_samples; ++i) {
        if (!is_covered(block, i)) continue;
        const std::size_t to =
            first + static_cast<std::size_t>(exact_point_index(k, samples.per_pixel, i % frame_tile_side,
                                                               first_row + i / frame_tile_side));
        samples.px[to] = px[i];
        samples.py[to] = py[i];
        samples.pz[to] = pz[i];
        samples.gx[to] = block.gx[i];
        samples.gy[to] = block.gy[i];
        samples.gz[to] = block.gz[i];
        samples.face[to] = face[i];
        samples.triangle[to] = block.triangle[i];
        samples.covered_words[to / 16] |= 1u << (to % 16);
        samples.thin_words[to / 16] |= (block.thin[i / 16] >> (i % 16) & 1u) << (to % 16);
    }
}

}  // namespace

ExactPoints FrameSamples::points(std::size_t tile) const {
    const std::size_t first = tile * per_tile();
    return {static_cast<std::int32_t>(per_tile()),
            px.data() + first,
            py.data() + first,
            pz.data() + first,
            gx.data() + first,
            gy.data() + first,
            gz.data() + first,
            face.data() + first,
            triangle.data() + first,
            covered_words.data() + first / 16,
            thin_words.data() + first / 16};
}

FrameSamples frame_samples(const Scene& scene, const Exec& exec) {
    FrameCache cache;
    FrameStats stats;
    prepare_scene(scene, exec, cache, stats);
    const TileScene tiles = prepare_tiles(scene, exec, cache);
    FrameSamples samples;
    samples.per_pixel = static_cast<int>(tiles.pattern.size());
    CHECK(samples.per_pixel <= exact_samples_together);
    samples.rays = tiles.rays;
    const int columns = tiles.bins->columns;
    samples.tiles = static_cast<std::size_t>(columns) *
                    static_cast<std::size_t>((scene.render.height + frame_tile_side - 1) / frame_tile_side);
    const std::size_t all = samples.tiles * samples.per_tile();
    for (Buffer<double>* buffer : {&samples.px, &samples.py, &samples.pz})
        buffer->reset(all);
    for (Buffer<float>* buffer : {&samples.gx, &samples.gy, &samples.gz})
        buffer->reset(all);
    samples.face.reset(all);
    samples.triangle.reset(all);
    samples.covered_words.reset(all / 16);
    samples.thin_words.reset(all / 16);
    std::fill_n(samples.covered_words.data(), all / 16, 0u);
    std::fill_n(samples.thin_words.data(), all / 16, 0u);
    parallel_for(samples.tiles, exec, [&](std::size_t t) {
        const auto work = std::make_unique<TileWork>();
        for (int k = 0; k < samples.per_pixel; ++k) {
            const SamplePosition sample = tiles.pattern[static_cast<std::size_t>(k)];
            walk_blocks(tiles, t, sample, exec.isa, *work, [&](const TileRect&, int first_row) {
                keep(work->surface, scene, t * samples.per_tile(), k, first_row, samples);
            });
        }
    });
    for (std::size_t i = 0; i < all / 16; ++i)
        samples.covered += static_cast<std::size_t>(std::popcount(samples.covered_words[i]));
    return samples;
}

}  // namespace obscura
