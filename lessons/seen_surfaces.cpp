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

constexpr int tile_columns = seen_width / frame_tile_side, tile_rows = seen_height / frame_tile_side;

}  // namespace

std::vector<SurfaceBlock> seen_surfaces(const Mesh& mesh, const Camera& camera, const Exec& exec) {
    const View view = camera_view(camera, seen_width, seen_height);
    const CameraRays rays = camera_rays(camera, seen_width, seen_height);
    RasterScratch scratch;
    setup_triangles(mesh, view, {}, exec, scratch.setup);
    bin_records(scratch.setup, {0, 0, seen_width, seen_height}, frame_tile_side, exec, scratch.bins);
    SurfaceTables tables;
    const std::uint32_t slots = 1 + *std::max_element(mesh.material.begin(), mesh.material.end());
    surface_tables(mesh, std::vector<Material>(slots), exec, tables);
    const SurfaceMesh surface = surface_mesh(mesh, tables);
    constexpr int per_tile = frame_tile_side / block_rows;
    std::vector<SurfaceBlock> blocks(tile_columns * tile_rows * per_tile);
    parallel_for(tile_columns * tile_rows, exec, [&](std::size_t i) {
        struct Work {
            alignas(64) float depth[frame_tile_side * frame_tile_side];
            alignas(64) std::uint32_t triangle[frame_tile_side * frame_tile_side];
        };
        const auto work = std::make_unique<Work>();
        const int column = static_cast<int>(i) % tile_columns, row = static_cast<int>(i) / tile_columns;
        const TileRect tile{column * frame_tile_side, row * frame_tile_side, frame_tile_side,
                            frame_tile_side};
        std::fill_n(work->depth, frame_tile_side * frame_tile_side, view.max_depth);
        std::fill_n(work->triangle, frame_tile_side * frame_tile_side, no_triangle);
        const auto list = scratch.bins.list(column, row);
        OBSCURA_DISPATCH(exec.isa, visibility_tile, scratch.setup.records.data(), list.data(), list.size(),
                         tile, work->depth, work->triangle);
        for (int b = 0; b < per_tile; ++b) {
            SurfaceBlock& block = blocks[i * per_tile + static_cast<std::size_t>(b)];
            std::copy_n(work->depth + b * block_samples, block_samples, block.depth);
            std::copy_n(work->triangle + b * block_samples, block_samples, block.triangle);
            OBSCURA_DISPATCH(exec.isa, surface_block, surface, rays, tile, b * block_rows, block);
        }
    });
    return blocks;
}

Vec2d seen_pixel(std::size_t sample) {
    const std::size_t tile = sample / (frame_tile_side * frame_tile_side),
                      within = sample % (frame_tile_side * frame_tile_side);
    return {static_cast<double>(tile % tile_columns * frame_tile_side + within % frame_tile_side),
            static_cast<double>(tile / tile_columns * frame_tile_side + within / frame_tile_side)};
}

}  // namespace obscura
