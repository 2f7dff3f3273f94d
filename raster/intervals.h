#pragma once
// From the crossings of one ray to its depth interval. Who may receive shadows decides what it may hold.
//
// Receivers::any: the entry/exit counter of L. Scandolo, P. Bauszat, E. Eisemann, "Compressed Multiresolution
// Hierarchies for High-Quality Precomputed Shadows", Eurographics 2016, section 3: a counter goes up at front
// faces and down at back faces; the interval begins at the first crossing and ends where the counter is back
// at zero. What the paper leaves open, and our policy, which never leaks light:
//  - An open surface outside solids gives the zero-width interval [z, z]; inside a solid it does not matter.
//  - A back face met while the counter is zero gives [z, z]: a flipped solid, a solid cut open by the near
//    plane, the light inside a solid.
//  - A counter that never returns to zero gives [entry, entry].
//
// Receivers::static_only: only surfaces of the scene ask, and along a ray they lie at its crossings. So the
// interval reaches from the first crossing up to, not including, the next deeper one, or to 1 where none
// follows: whatever is stored there, the first surface is lit and every other is dark, be they sheets, sheets
// back to back, solids that touch, what stands inside a solid, or the walls of a room that hold the light. No
// counter, no openness.
//
// Nothing at all gives the background [1, 1].

#include <cstdint>
#include <span>

#include "core/types.h"
#include "raster/record.h"

namespace obscura {

/// Who receives shadows: `any` point outside solids (the papers' rule, for trees that are kept for receivers
/// which the scene does not have), or only the scene's own surfaces, as in every picture of it.
enum class Receivers { any, static_only };

/// One crossing of a texel's ray with a triangle.
struct LayerCrossing {
    float depth = 0;
    Crossing crossing = Crossing::entry;
    std::uint32_t triangle = 0;
    friend bool operator==(const LayerCrossing&, const LayerCrossing&) = default;
};

/// The order of crossings: depth, then kind, then triangle. Nothing depends on how they were found.
bool comes_before(const LayerCrossing& p, const LayerCrossing& q);

/// Interval of a ray from its crossings in order.
DepthInterval interval_of(std::span<const LayerCrossing> ordered, Receivers receivers);

/// The greatest float below `depth`.
float just_before(float depth);

}  // namespace obscura
