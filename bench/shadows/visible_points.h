#pragma once
// The points that a picture's pixels see, as the renderer's own stages find them.

#include <vector>

#include "app/scene/scene.h"
#include "core/isa.h"
#include "raster/gbuffer.h"

namespace obscura {

/// Surfaces of all pixels, one sample each, in blocks of 64 x 4 pixels, row by row of blocks.
struct VisiblePoints {
    int width = 0, height = 0;
    Vec3d eye;  ///< positions are relative to it
    std::vector<SurfaceBlock> blocks;
    std::size_t covered = 0;  ///< pixels that see a surface

    int columns() const { return width / frame_tile_side; }
    /// Pixel of sample `at` of block `block`, as an index into the picture's rows.
    std::size_t pixel(std::size_t block, int at) const {
        const auto columns_of = static_cast<std::size_t>(columns());
        const std::size_t x =
            block % columns_of * frame_tile_side + static_cast<std::size_t>(at % frame_tile_side);
        const std::size_t y =
            block / columns_of * block_rows + static_cast<std::size_t>(at / frame_tile_side);
        return y * static_cast<std::size_t>(width) + x;
    }
};

constexpr bool is_covered(const SurfaceBlock& block, int at) {
    return (block.covered[at / 16] >> (at & 15) & 1u) != 0;
}

/// Visibility, then surfaces, of scene.render's picture: width a multiple of 64, height of 4, one sample.
VisiblePoints visible_points(const Scene& scene, const Exec& exec);

}  // namespace obscura
