#pragma once
// `obscura bench raster`: ours against llvmpipe and Embree in one run on one machine.

#include <optional>
#include <string>
#include <vector>

#include "bench/harness/contestant.h"
#include "bench/harness/options.h"
#include "bench/raster/workloads.h"

namespace obscura {

/// How a job's result relates to the reference (the first contestant that delivers this workload).
struct Agreement {
    double covered = 0;        ///< fraction of texels or pixels that are not background
    double mean_first = 0;     ///< mean depth of the first layer where covered; frames: mean luminance
    double mean_second = 0;    ///< mean depth of the second layer where there is one
    double wrong = -1;         ///< fraction of texels whose depth is off by more than 1e-5; -1 = not compared
    double wrong_inside = -1;  ///< the same without silhouettes, as a fraction of the texels left
};

/// One line of the result.
struct BenchRow {
    std::string scene;
    std::size_t triangles = 0;
    Workload workload = Workload::depth;
    int width = 0, height = 0;
    std::string contestant, method, version;
    int threads = 1;
    bool same_work = true;  ///< see Job
    std::vector<double> runs_ms;
    double prepare_ms = 0, prepare_mib = 0;
    std::optional<Agreement> agreement;
    std::string problem;  ///< why there are no times: absent or failed
};

/// Measures every contestant on one scene: interleaved runs, order reversed every other time.
std::vector<BenchRow> measure_scene(const std::vector<Contestant>& contestants, const BenchScene& scene,
                                    const BenchOptions& options);

/// Everyone who takes part, ours first. Contestants that this build lacks say so in `absent`.
std::vector<Contestant> all_contestants();

/// The whole bench: measures, writes raster.csv, raster_runs.csv, raster.md and, with gnuplot, one SVG per
/// workload into options.out. Returns an exit code. Throws OutputError.
int bench_raster(const BenchOptions& options);

}  // namespace obscura
