#pragma once
// Results as files: CSV for programs, Markdown for people.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/raster/raster_bench.h"

namespace obscura {

/// Heading of a row's workload, with its size.
std::string workload_title(const BenchRow& row);

/// The fastest row of a scene, workload and thread count that does the whole work and for which `take` is
/// true; null when there is none.
const BenchRow* fastest(const std::vector<BenchRow>& rows, const std::string& scene, Workload workload,
                        int threads, const std::function<bool(const BenchRow&)>& take);

/// Median over the fastest of ours with the same scene, workload and threads; nothing without times.
std::optional<double> ratio_to_ours(const std::vector<BenchRow>& rows, const BenchRow& row);

/// One line per row: what, who, times, agreement.
std::string summary_csv(const std::vector<BenchRow>& rows);
/// One line per timed run.
std::string runs_csv(const std::vector<BenchRow>& rows);
/// Machine, headline ratios, every time, agreement of results.
std::string report_markdown(const std::vector<BenchRow>& rows, const BenchOptions& options);

/// Writes raster.csv, raster_runs.csv and raster.md into options.out, which is made if need be. Throws
/// OutputError.
void write_report(const std::vector<BenchRow>& rows, const BenchOptions& options);

}  // namespace obscura
