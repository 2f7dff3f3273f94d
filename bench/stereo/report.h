#pragma once
// Results of the stereo bench as files: CSV for programs, Markdown for people, a chart.

#include <string>

#include "bench/harness/gnuplot.h"
#include "bench/harness/options.h"
#include "bench/stereo/results.h"

namespace obscura {

/// The row of a method at one size with so many threads; null: none.
const StereoRow* find_row(const StereoResults& results, const StereoRow& like, const std::string& method,
                          int threads);

/// Milliseconds in passes over memory of the same size and thread count; 0 when no pass was measured.
double in_passes(const StereoResults& results, const StereoRow& row, double ms);

/// What the project aims at, and what this run reached.
std::string stereo_goals_markdown(const StereoResults& results);

std::string stereo_csv(const StereoResults& results);         ///< a line per method, size, thread count
std::string stereo_curves_csv(const StereoResults& results);  ///< a line per point of error against time
std::string stereo_cases_csv(const StereoResults& results);
std::string stereo_markdown(const StereoResults& results, const BenchOptions& options);

/// Colour and point of a method in every chart.
MethodStyle stereo_style(const std::string& method);

/// Writes stereo.md, stereo.csv, stereo_curves.csv and stereo_cases.csv into options.out. Throws OutputError.
void write_stereo_report(const StereoResults& results, const BenchOptions& options);

/// Writes stereo.svg. Without gnuplot says so and draws nothing.
void draw_stereo_chart(const StereoResults& results, const BenchOptions& options);

}  // namespace obscura
