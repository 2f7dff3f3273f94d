#pragma once
// The workloads of the raster bench: their names, and how large their results are.

#include <cstddef>
#include <string>

#include "bench/harness/contestant.h"

namespace obscura {

/// Those of the raster bench.
inline constexpr Workload all_workloads[] = {Workload::depth, Workload::dual_depth, Workload::frame,
                                             Workload::static_frame};

/// Whether the result is a picture rather than maps of depths.
constexpr bool is_frame(Workload workload) {
    return workload == Workload::frame || workload == Workload::static_frame;
}

/// "depth", "dual depth", "frame", "static frame".
const char* workload_name(Workload workload);
/// The same for file names, with underscores.
std::string workload_file_name(Workload workload);
/// Number of floats in a result.
std::size_t result_size(Workload workload, const BenchScene& scene);

}  // namespace obscura
