#pragma once
// What the stages of a tile leave undefined, set to zero, so that the rest can be compared byte by byte.

#include <cstdint>

#include "raster/gbuffer.h"
#include "raster/shade.h"

namespace obscura::frame_scenes {

inline void forget_undefined(SurfaceBlock& s) {
    for (int at = 0; at < block_samples; ++at) {
        const auto in = [&](const std::uint32_t* masks) { return (masks[at / 16] >> (at & 15) & 1u) != 0; };
        if (!in(s.covered)) {
            for (float* plane : {s.nx, s.ny, s.nz, s.gx, s.gy, s.gz})
                plane[at] = 0;
        }
        if (!in(s.textured)) {
            for (float* plane : {s.u, s.v, s.ux, s.vx, s.uy, s.vy, s.texel_r, s.texel_g, s.texel_b})
                plane[at] = 0;
        }
    }
}

/// The same of what is shaded there.
inline void forget_undefined(const SurfaceBlock& s, ShadeBlock& shade) {
    for (int at = 0; at < block_samples; ++at) {
        const auto in = [&](const std::uint32_t* masks) { return (masks[at / 16] >> (at & 15) & 1u) != 0; };
        if (!in(s.covered)) {
            for (float* plane : {shade.nv, shade.veil, shade.smith_v, shade.alpha2, shade.diffuse_r,
                                 shade.diffuse_g, shade.diffuse_b, shade.f0_r, shade.f0_g, shade.f0_b})
                plane[at] = 0;
        }
        if (!in(s.covered) || !in(s.thin))
            shade.through_r[at] = shade.through_g[at] = shade.through_b[at] = 0;
    }
}

}  // namespace obscura::frame_scenes
