#include "bench/shadows/visible_points.h"

#include <bit>
#include <memory>

#include "app/frame/render_frame.h"
#include "core/error.h"
#include "core/parallel.h"

namespace obscura {

VisiblePoints visible_points(const Scene& scene, const Exec& exec) {
    VisiblePoints points;
    points.width = scene.render.width;
    points.height = scene.render.height;
    points.eye = scene.camera.eye;
    CHECK(points.width % frame_tile_side == 0 && points.height % block_rows == 0);
    CHECK(scene.render.samples == 1);

    FrameCache cache;
    FrameStats stats;
    prepare_scene(scene, exec, cache, stats);
    // The picture alone, without the margin that glare would have: its tiles are the blocks' grid.
    TileScene tiles = tile_scene(scene, points.width, points.height, scene.render.samples);
    set_up_triangles(scene.mesh, exec, cache.camera_scratch, tiles);
    tiles.mesh = &scene.mesh;
    tiles.surface = surface_mesh(scene.mesh, cache.surface);

    constexpr int blocks_per_tile = frame_tile_side / block_rows;
    const int columns = points.columns(), block_lines = points.height / block_rows;
    const int rows = (block_lines + blocks_per_tile - 1) / blocks_per_tile;
    points.blocks.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(block_lines));
    parallel_for(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), exec,
                 [&](std::size_t tile_index) {
                     const auto work = std::make_unique<TileWork>();
                     const int column = static_cast<int>(tile_index) % columns;
                     const int row = static_cast<int>(tile_index) / columns;
                     const TileRect tile =
                         tile_visibility(tiles, column, row, tiles.pattern[0], exec.isa, *work);
                     for (int b = 0; b < blocks_per_tile; ++b) {
                         const int line = row * blocks_per_tile + b;
                         if (line >= block_lines) break;
                         block_surface(tiles, tile, b * block_rows, exec.isa, *work);
                         points.blocks[static_cast<std::size_t>(line) * static_cast<std::size_t>(columns) +
                                       static_cast<std::size_t>(column)] = work->surface;
                     }
                 });
    for (const SurfaceBlock& block : points.blocks) {
        for (const std::uint32_t group : block.covered)
            points.covered += static_cast<std::size_t>(std::popcount(group));
    }
    return points;
}

}  // namespace obscura
