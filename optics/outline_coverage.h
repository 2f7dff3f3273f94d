#pragma once
// The area of every texel that an outline leaves open.

#include <cstdint>

#include "core/image.h"
#include "optics/field/aperture.h"

namespace obscura {

/// What it took to count windings; outlines that are disjoint take none.
struct CoverageWork {
    std::int64_t slabs = 0;      ///< parts of rows, between ends of edges that lie side by side
    std::int64_t strands = 0;    ///< edges in all of these, and pairs of those that cross
    std::int64_t crossings = 0;  ///< of two edges within a slab
};

/// Share of each texel of a width x height mask where the outline's winding number is positive, in [0, 1]:
/// exact areas of trapezoids in double, no samples. Texels touched by nothing are exactly 0 or 1 (areas below
/// 1e-9 count as 0). Parts outside the mask are cut off. Where a mask differs from its mirror image nowhere
/// by more than rounding (2^-22), it is made its mirror image bit for bit. Outline::disjoint is believed:
/// then nothing is sorted and the loops' signed areas just add up.
Image<float> coverage_of(const Outline& outline, int width, int height, CoverageWork* work = nullptr);

}  // namespace obscura
