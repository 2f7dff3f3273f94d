#pragma once
// Error, memory, build and lookup times of every method in one place: the first table and chart of a report.

#include <string>

#include "bench/harness/panel_chart.h"
#include "bench/shadows/results.h"

namespace obscura {

/// A section of the report, empty when the results have neither errors nor times. One line per method and
/// size whose lookups were timed, or, on scenes without times, whose errors are known.
std::string summary_markdown(const ShadowResults& results);

/// A column of panels per scene that was timed at most sizes; error, memory, build and lookups downwards.
PanelChart summary_chart(const ShadowResults& results);

}  // namespace obscura
