#pragma once
// Results of the diffraction bench as files: CSV for programs, Markdown for people, charts.

#include <functional>
#include <string>
#include <vector>

#include "bench/diffraction/results.h"
#include "bench/harness/gnuplot.h"
#include "bench/harness/options.h"

namespace obscura {

/// Rows for which `take` is true.
std::vector<DiffractionRow> rows_where(const std::vector<DiffractionRow>& rows,
                                       const std::function<bool(const DiffractionRow&)>& take);

/// Least time of the row that agrees with `like` in part, aperture, size, threads, and has this method; 0
/// when there is none.
double least_ms(const std::vector<DiffractionRow>& rows, const DiffractionRow& like,
                const std::string& method, bool one_call);

/// "Diffraction" of the goals, each with what was reached.
std::string goals_markdown(const DiffractionResults& results);

/// The thesis's tables and figures.
std::string thesis_markdown(const DiffractionResults& results);

std::string diffraction_csv(const std::vector<DiffractionRow>& rows);
std::string diffraction_markdown(const DiffractionResults& results, const BenchOptions& options);

/// Colour and point of a method in every chart.
MethodStyle diffraction_style(const std::string& method);

/// Writes diffraction.md and diffraction.csv into options.out. Throws OutputError.
void write_diffraction_report(const DiffractionResults& results, const BenchOptions& options);

/// Writes diffraction_{time,error,window,near,near_error}.svg, those that have something to show. Without
/// gnuplot says so and draws nothing.
void draw_diffraction_charts(const DiffractionResults& results, const BenchOptions& options);

}  // namespace obscura
