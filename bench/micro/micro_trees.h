#pragma once
// The tree workloads of obscura_micro_bench.

namespace obscura {

/// Lookups of one view's visible points in trees of several resolutions, by every form of lookup.
void add_tree_benchmarks();

}  // namespace obscura
