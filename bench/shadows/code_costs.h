#pragma once
// What it costs to keep one map in every code, and in those of others.

#include <vector>

#include "bench/shadows/code_bench.h"
#include "bench/shadows/visible_points.h"
#include "hierarchy/multires.h"

namespace obscura {

/// Our codes, with lookups at the points seen, one thread, the codes taking turns. `build_s`: of the tree.
std::vector<CodeCost> tree_costs(const Scene& scene, const MultiresTree& tree, const LightView& view,
                                 const VisiblePoints& seen, double build_s, const BenchOptions& options);

/// Of the same map: dense, as scanlines, as voxels (bench/peer_codes). These look at every texel.
std::vector<CodeCost> peer_costs(const Scene& scene, const LightView& view, const Exec& exec);

}  // namespace obscura
