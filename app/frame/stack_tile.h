#pragma once
// A light with a size whose points are maps of a stack, over a block of samples.
//
// All points are asked at once, and shine in runs that lie together on the light: a run's share of lit points
// dims the light of all of it, from its middle. With as many runs as points that is what a light each makes
// of them; with fewer, highlights and cosines are those of the runs' middles.

#include <cstdint>
#include <span>
#include <vector>

#include "core/isa.h"
#include "core/vec.h"
#include "hierarchy/stack/stack_query.h"
#include "raster/shade.h"

namespace obscura {

struct LightShadow;

/// Runs that a light's points shine in, at most: the largest power of two that divides them. Parts of the
/// sun's disc look alike from anywhere.
constexpr int most_shaded_parts = 64, most_shaded_parallel = 16;

/// A stack as the tiles of one picture ask it. Borrows the shadow's stack.
struct StackLight {
    StackLookup lookup;
    std::vector<ShadeLight> parts;
    float per_point = 1;  ///< share of a part that one of its points is
    bool parallel = false;
    Vec3f middle;  ///< of the light: the way to it, or its place relative to the eye
};

/// Of shadow.stack, for points relative to the eye.
StackLight stack_light(const LightShadow& shadow, Vec3d eye);

/// How many points of each part reach each sample of a block: lit[part * block_samples + i]; 0 where nothing
/// is covered. `lit` has room for light.parts.size() * block_samples. Thin surfaces are lit from either side.
void stack_block(const StackLight& light, const SurfaceBlock& surface, Isa isa, std::uint16_t* lit);

/// The visibility of one part over a block, from those counts. Surfaces that face away from the part have 0.
void part_visibility(const StackLight& light, std::size_t part, const SurfaceBlock& surface,
                     const std::uint16_t* lit, float* visibility);

/// Both, and the light's shading. `shadow_sum`, unless null: the mean visibility of the parts is added.
void shade_stack(const StackLight& light, const SurfaceBlock& surface, Isa isa, float* visibility,
                 float* shadow_sum, ShadeBlock& shade);

}  // namespace obscura
