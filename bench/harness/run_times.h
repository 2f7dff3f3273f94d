#pragma once
// Wall-clock times of repeated runs: taking one, and telling many.

#include <functional>
#include <string>
#include <vector>

namespace obscura {

/// Wall-clock milliseconds of one call.
double milliseconds_of(const std::function<void()>& run);

/// Of one value at least.
double median(std::vector<double> values);

/// "12.3 (12.0 to 13.1)", median and range; "-" without runs.
std::string range_text(const std::vector<double>& runs_ms, int decimals);

/// The same as three fields of a CSV line, each with its comma; empty fields without runs.
std::string range_fields(const std::vector<double>& runs_ms);

}  // namespace obscura
