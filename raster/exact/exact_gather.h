#pragma once
// Sixteen samples of a light with a size, and what is within its reach of them. Kernel files only; the
// meaning of each step is in exact_soft_ref.cpp.

#include "raster/exact/exact_bunch.h"
#include "raster/exact/exact_receivers.h"
#include "raster/exact/exact_soft.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Sixteen points of one view of the middle in some order, or fewer: the others repeat the first.
struct Gathered {
    Bunch bunch;  ///< on the middle's grid
    alignas(64) float gx[16], gy[16], gz[16];
    std::uint32_t thin;
    bool is_far;  ///< some place is not known, being too far off the grid
};

OBSCURA_INLINE void gather(const ExactPoints& points, const ExactLight& middle, const ExactSamples& samples,
                           const std::uint32_t* order, int n, Gathered& to) {
    gather_bunch(points, middle, samples, order, n, to.bunch);
    to.thin = 0;
    for (int k = 0; k < 16; ++k) {
        const auto at = static_cast<std::uint32_t>(to.bunch.point[k]);
        to.gx[k] = points.gx[at];
        to.gy[k] = points.gy[at];
        to.gz[k] = points.gz[at];
        to.thin |= (points.thin[at / 16] >> (at % 16) & 1u) << k;
    }
    constexpr auto beyond = static_cast<std::int32_t>(exact_beyond);
    const Extent& e = to.bunch.extent;
    to.is_far = least(e.x_low, e.y_low) <= -beyond || most(e.x_high, e.y_high) >= 2 * beyond;
}

/// Boxes that reach into `e` widened by what their depth makes of the light's size.
OBSCURA_INLINE std::uint32_t within_reach(const CasterBoxes& boxes, const Extent& e,
                                          const ExactSpread& spread, int view) {
    const F32 z_low = load(boxes.z_low), z_high = splat(e.z_high);
    const F32 steps = splat(spread.steps_per_depth[view]) * (z_high - z_low);
    const I32 reach = to_i32(min(max(steps, splat(0.0f)), splat(exact_most_reach))) + splat(spread.slack);
    return bits(less_equal(load(boxes.x_low), splat(e.x_high) + reach) &
                less_equal(splat(e.x_low) - reach, load(boxes.x_high)) &
                less_equal(load(boxes.y_low), splat(e.y_high) + reach) &
                less_equal(splat(e.y_low) - reach, load(boxes.y_high)) & less_equal(z_low, z_high));
}

/// Calls visit(triangle's place, its nearest depth) for what is within reach of e, until it returns false.
template <class Visit>
OBSCURA_INLINE void walk_reach(const ExactView& view, const Extent& e, const ExactSpread& spread, int v,
                               std::int64_t& groups, Visit&& visit) {
    walk(
        view, groups, [&](const CasterBoxes& boxes) { return within_reach(boxes, e, spread, v); },
        [&](const CasterBoxes& boxes, std::uint32_t first, int k) {
            return visit(first + static_cast<std::uint32_t>(k), boxes.z_low[k]);
        });
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
