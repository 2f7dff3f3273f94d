#pragma once
// What a camera sees in a small picture, found by the renderer's own stages.

#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "core/scene.h"
#include "raster/gbuffer.h"

namespace obscura {

constexpr int seen_width = 7 * frame_tile_side, seen_height = 4 * frame_tile_side;

/// Surfaces of the picture's pixels, one sample each: tile by tile, the rows of a tile in blocks.
std::vector<SurfaceBlock> seen_surfaces(const Mesh& mesh, const Camera& camera, const Exec& exec);

/// The pixel of a sample, counted through all blocks.
Vec2d seen_pixel(std::size_t sample);

}  // namespace obscura
