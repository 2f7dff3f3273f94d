#pragma once
// Do contestants compute the same thing? Statistics of their results against a reference.

#include "bench/raster/raster_bench.h"

namespace obscura {

/// Fraction covered and mean values of a result (see Workload for its layout).
Agreement summarise(Workload workload, const BenchScene& scene, const float* result);

/// Fills `wrong` and `wrong_inside` by comparing first layers. A texel is on a silhouette when the reference
/// is not close to planar there: a second difference along one of four directions exceeds 1e-4 of the depth
/// range, or a neighbour is background while it is not.
void compare_depths(Agreement& agreement, const BenchScene& scene, const float* result,
                    const float* reference);

}  // namespace obscura
