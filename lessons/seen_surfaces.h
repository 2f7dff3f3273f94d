#pragma once
// What a camera sees in a small picture, found by the renderer's own stages.

#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "core/scene.h"
#include "raster/gbuffer.h"

namespace obscura {

/// A mesh drawn somewhere else than its surface is: `drawn` where it is seen, `mesh` where its surface is,
/// `moved_to` the vertices where it is seen. Null: all are one.
struct SeenMesh {
    const Mesh& mesh;
    const Mesh& drawn;
    const std::vector<Vec3f>* moved_to = nullptr;
    explicit SeenMesh(const Mesh& all) : mesh(all), drawn(all) {}
    SeenMesh(const Mesh& surface, const Mesh& seen, const std::vector<Vec3f>& vertices)
        : mesh(surface), drawn(seen), moved_to(&vertices) {}
};

/// Surfaces of the picture's pixels, one sample each: tile by tile, the rows of a tile in blocks; tiles at
/// the right and lower border reach beyond the picture.
std::vector<SurfaceBlock> seen_surfaces(const SeenMesh& seen, const Camera& camera, int width, int height,
                                        const Exec& exec);

/// The pixel of a sample, counted through all blocks.
struct SeenPixel {
    int x = 0, y = 0;
};
SeenPixel seen_pixel(std::size_t sample, int width);

}  // namespace obscura
