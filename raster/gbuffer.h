#pragma once
// The G-buffer of a few rows of a tile: for every covered sample its position, normals, texture coordinates,
// material. Structure of arrays, small enough for the first-level cache, never a whole picture. POD: kernels
// include this.
//
// Deering et al., "The Triangle Processor and Normal Vector Shader", SIGGRAPH 1988, for shading after
// visibility; Burns and Hunt, "The Visibility Buffer", JCGT 2013, for storing only triangle ids per sample
// and finding everything else again from the sample's ray; Moeller and Trumbore, "Fast, Minimum Storage
// Ray/Triangle Intersection", JGT 1997, for the barycentrics; Igehy, "Tracing Ray Differentials", SIGGRAPH
// 1999, for their derivatives.

#include <cstdint>

#include "raster/camera_rays.h"
#include "raster/record.h"

namespace obscura {

constexpr int frame_tile_side = 64;
constexpr int block_rows = 4;
constexpr int block_samples = frame_tile_side * block_rows;
constexpr int block_groups = block_samples / 16;  ///< groups of 16 neighbours in a row

/// What shading asks of a triangle before it asks for corners: 16 bytes.
struct SurfaceTriangle {
    float normal[3];     ///< unit, to the side it is counter-clockwise from
    std::uint32_t info;  ///< material, and the flags below
};
constexpr std::uint32_t surface_material_mask = 0x0fffffffu;
constexpr std::uint32_t surface_open = 1u << 28;      ///< of a component that is open or inside out
constexpr std::uint32_t surface_smooth = 1u << 29;    ///< corner normals differ from the face's
constexpr std::uint32_t surface_textured = 1u << 30;  ///< material has a texture, mesh has uvs
constexpr std::uint32_t surface_thin = 1u << 31;      ///< material lets light through

/// Everything about a vertex in half a cache line, so that a corner costs one memory access.
struct alignas(32) SurfaceVertex {
    float position[3], normal[3], uv[2];
};

/// A mesh as the surface stage reads it.
struct SurfaceMesh {
    const SurfaceTriangle* triangles = nullptr;
    const SurfaceVertex* vertices = nullptr;
    const std::uint32_t* corners = nullptr;  ///< three vertex indices per triangle
    /// Where the vertices are seen, x y z each, when that is not where they are; else null. Rays then meet
    /// the triangles that are seen; what they find there (position, normals, texture coordinates) is of the
    /// vertices themselves, by the same barycentrics. Which side faces the viewer is as seen.
    const float* seen = nullptr;
    /// With `seen`: how many pixels further right lies what the ray of an uncovered sample shows.
    float background_shift_px = 0;
};

/// One block of samples: index = row * 64 + column. Bit i of a mask word is sample 16 * group + i.
struct alignas(64) SurfaceBlock {
    // In: filled by visibility.
    float depth[block_samples];
    std::uint32_t triangle[block_samples];
    // Every sample. Where nothing is covered, the position is the ray at z = 1.
    float px[block_samples], py[block_samples], pz[block_samples];  ///< metres, relative to the eye
    // Covered samples. Normals are unit length and turned to the viewer where the face is seen from behind.
    float nx[block_samples], ny[block_samples], nz[block_samples];  ///< shading normal
    float gx[block_samples], gy[block_samples], gz[block_samples];  ///< geometric normal
    std::int32_t material[block_samples];                           ///< 0 where nothing is covered
    // Textured samples.
    float u[block_samples], v[block_samples];
    float ux[block_samples], vx[block_samples];  ///< d(u, v) per pixel to the right
    float uy[block_samples], vy[block_samples];  ///< d(u, v) per pixel down
    float texel_r[block_samples], texel_g[block_samples],
        texel_b[block_samples];  ///< by sample_textures()
    std::uint32_t covered[block_groups], open[block_groups], textured[block_groups], thin[block_groups];
};

/// surface_block: everything of `block` but the texels, from its depth and triangle. `tile` is the whole
/// tile; `first_row` the block's first row in it. Barycentrics are clamped to the triangle. With mesh.seen
/// rays are perspective.
#define OBSCURA_SURFACE_BLOCK                                                                 \
    void surface_block(const SurfaceMesh& mesh, const CameraRays& rays, const TileRect& tile, \
                       std::int32_t first_row, SurfaceBlock& block) noexcept;
namespace ref {
OBSCURA_SURFACE_BLOCK
}
namespace sse2 {
OBSCURA_SURFACE_BLOCK
}
namespace avx2 {
OBSCURA_SURFACE_BLOCK
}
namespace avx512bw {
OBSCURA_SURFACE_BLOCK
}
#undef OBSCURA_SURFACE_BLOCK

}  // namespace obscura
