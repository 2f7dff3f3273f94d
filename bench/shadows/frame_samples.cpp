#include "bench/shadows/frame_samples.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "app/frame/exact_tile.h"
#include "app/frame/render_frame.h"
#include "core/error.h"
#include "core/parallel.h"
#include "raster/exact/exact_shadow.h"

namespace obscura {
namespace {

void keep(const SurfaceBlock& block, const Scene& scene, std::size_t to, FrameSamples& samples) {
    std::copy_n(block.triangle, block_samples, samples.triangle.data() + to);
    std::copy_n(block.gx, block_samples, samples.gx.data() + to);
    std::copy_n(block.gy, block_samples, samples.gy.data() + to);
    std::copy_n(block.gz, block_samples, samples.gz.data() + to);
    std::copy_n(block.covered, block_groups, samples.covered_words.data() + to / 16);
    std::copy_n(block.thin, block_groups, samples.thin_words.data() + to / 16);
    exact_positions(block, scene.mesh, scene.camera.eye, samples.px.data() + to, samples.py.data() + to,
                    samples.pz.data() + to, samples.face.data() + to);
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
    parallel_for(samples.tiles, exec, [&](std::size_t t) {
        const auto work = std::make_unique<TileWork>();
        for (int k = 0; k < samples.per_pixel; ++k) {
            const SamplePosition sample = tiles.pattern[static_cast<std::size_t>(k)];
            walk_blocks(tiles, t, sample, exec.isa, *work, [&](const TileRect&, int first_row) {
                const std::size_t at =
                    t * samples.per_tile() + static_cast<std::size_t>(FrameSamples::index(k, 0, first_row));
                keep(work->surface, scene, at, samples);
            });
        }
    });
    for (std::size_t i = 0; i < all / 16; ++i)
        samples.covered += static_cast<std::size_t>(std::popcount(samples.covered_words[i]));
    return samples;
}

}  // namespace obscura
