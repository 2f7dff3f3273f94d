#include "lessons/seen_surfaces.h"

#include <algorithm>
#include <memory>

#include "core/parallel.h"
#include "raster/depth_map.h"
#include "raster/depth_tile.h"
#include "raster/surface.h"
#include "raster/view.h"

namespace obscura {
namespace {

constexpr int blocks_per_tile = frame_tile_side / block_rows;

/// Tiles that a length of pixels touches.
int tiles_along(int pixels) {
    return (pixels + frame_tile_side - 1) / frame_tile_side;
}

}  // namespace

std::vector<SurfaceBlock> seen_surfaces(const SeenMesh& seen, const Camera& camera, int width, int height,
                                        const Exec& exec) {
    const View view = camera_view(camera, width, height);
    const CameraRays rays = camera_rays(camera, width, height);
    RasterScratch scratch;
    setup_triangles(seen.drawn, view, {}, exec, scratch.setup);
    bin_records(scratch.setup, {0, 0, width, height}, frame_tile_side, exec, scratch.bins);
    SurfaceTables tables;
    const std::uint32_t slots = 1 + *std::max_element(seen.mesh.material.begin(), seen.mesh.material.end());
    surface_tables(seen.mesh, std::vector<Material>(slots), exec, tables);
    SurfaceMesh surface = surface_mesh(seen.mesh, tables);
    if (seen.moved_to != nullptr) surface.seen = &seen.moved_to->front().x;
    const int columns = tiles_along(width), tiles = columns * tiles_along(height);
    std::vector<SurfaceBlock> blocks(static_cast<std::size_t>(tiles * blocks_per_tile));
    parallel_for(static_cast<std::size_t>(tiles), exec, [&](std::size_t i) {
        struct Work {
            alignas(64) float depth[frame_tile_side * frame_tile_side];
            alignas(64) std::uint32_t triangle[frame_tile_side * frame_tile_side];
        };
        const auto work = std::make_unique<Work>();
        const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
        const TileRect tile{column * frame_tile_side, row * frame_tile_side, frame_tile_side,
                            frame_tile_side};
        std::fill_n(work->depth, frame_tile_side * frame_tile_side, view.max_depth);
        std::fill_n(work->triangle, frame_tile_side * frame_tile_side, no_triangle);
        const auto list = scratch.bins.list(column, row);
        OBSCURA_DISPATCH(exec.isa, visibility_tile, scratch.setup.records.data(), list.data(), list.size(),
                         tile, work->depth, work->triangle);
        for (int b = 0; b < blocks_per_tile; ++b) {
            SurfaceBlock& block = blocks[i * blocks_per_tile + static_cast<std::size_t>(b)];
            std::copy_n(work->depth + b * block_samples, block_samples, block.depth);
            std::copy_n(work->triangle + b * block_samples, block_samples, block.triangle);
            OBSCURA_DISPATCH(exec.isa, surface_block, surface, rays, tile, b * block_rows, block);
        }
    });
    return blocks;
}

SeenPixel seen_pixel(std::size_t sample, int width) {
    constexpr int tile_samples = frame_tile_side * frame_tile_side;
    const auto columns = static_cast<std::size_t>(tiles_along(width));
    const std::size_t tile = sample / tile_samples, within = sample % tile_samples;
    return {static_cast<int>(tile % columns * frame_tile_side + within % frame_tile_side),
            static_cast<int>(tile / columns * frame_tile_side + within / frame_tile_side)};
}

}  // namespace obscura
