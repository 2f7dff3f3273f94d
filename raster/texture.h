#pragma once
// Texture lookups: trilinear filtering of a mip chain (Williams, "Pyramidal Parametrics", SIGGRAPH 1983),
// repeat wrap.

#include <span>

#include "core/scene.h"
#include "raster/gbuffer.h"
#include "raster/shade.h"

namespace obscura {

/// Derivatives of (u, v) per pixel to the right and down.
struct UvFootprint {
    Vec2f per_x, per_y;
};

/// log2(x) for finite x > 0 from the exponent bits and a polynomial, to 1.5e-4.
float fast_log2(float x);

/// Mip level for a footprint: log2 of the longer of its two sides in texels of level 0, at least 0, at most
/// the last level.
float mip_level(const Texture& texture, const UvFootprint& footprint);

/// Bilinear lookup in one level. (0, 0) is the lower left corner; coordinates repeat outside [0, 1).
Vec3f sample_level(const Texture& texture, int level, Vec2f uv);

/// Trilinear lookup at a fractional level in [0, levels - 1].
Vec3f sample_trilinear(const Texture& texture, Vec2f uv, float level);

/// Fills block.texel_* of every textured sample.
void sample_textures(SurfaceBlock& block, std::span<const ShadeMaterial> materials,
                     std::span<const Texture> textures);

}  // namespace obscura
