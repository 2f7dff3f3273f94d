#pragma once
// Charts of a bench run, by gnuplot.

#include "bench/raster/raster_bench.h"

namespace obscura {

/// gnuplot commands that write one SVG to standard output: every method of a workload as a line of its own,
/// times on a logarithmic axis as points (hollow: fewest threads) with bars from the least to the greatest
/// run, and the ratio to Obscura's fastest as text. Empty when the workload has no times.
std::string chart_script(const std::vector<BenchRow>& rows, Workload workload, const BenchOptions& options);

/// Writes one raster_WORK.svg per workload into options.out. Without gnuplot says
/// so and draws nothing.
void draw_charts(const std::vector<BenchRow>& rows, const BenchOptions& options);

}  // namespace obscura
