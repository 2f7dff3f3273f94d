#pragma once
// Results of the shadow bench as files: CSV for programs, Markdown for people.

#include <string>

#include "bench/harness/gnuplot.h"
#include "bench/harness/options.h"
#include "bench/shadows/results.h"

namespace obscura {

/// "4096", "64k", "1M".
std::string size_name(int size);
/// "dense 16k", "compressed 256k", "Embree".
std::string method_name(const std::string& method, int size);

/// What of several threads and jobs belongs together.
struct MethodKey {
    std::string scene, method;
    int size = 0;
    bool operator==(const MethodKey&) const = default;
};
/// The row of a method's job with so many threads; null when there is none with times.
const TimeRow* find_time(const std::vector<TimeRow>& rows, const MethodKey& of, const std::string& job,
                         int threads);

/// Colour and point of a method in every chart.
MethodStyle shadow_style(const std::string& method);
/// gnuplot commands: texels a side from 1k to 1M.
std::string size_tics();

std::string accuracy_csv(const std::vector<AccuracyRow>& rows);
std::string sweep_csv(const std::vector<SweepRow>& rows);
std::string times_csv(const std::vector<TimeRow>& rows);
std::string trees_csv(const std::vector<SizeRow>& rows);
std::string directions_csv(const std::vector<DirectionRow>& rows);
std::string shadow_markdown(const ShadowResults& results, const BenchOptions& options);

/// Writes shadows.md and shadows_{accuracy,wrong,times,trees,directions}.csv, those that have rows, into
/// options.out. Throws OutputError.
void write_shadow_report(const ShadowResults& results, const BenchOptions& options);

/// Writes shadows_{summary,accuracy,bytes,lookups,trees}.svg, those that have something to show. Without
/// gnuplot says so and draws nothing.
void draw_shadow_charts(const ShadowResults& results, const BenchOptions& options);

}  // namespace obscura
