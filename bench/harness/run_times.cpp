#include "bench/harness/run_times.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/stopwatch.h"

namespace obscura {

double milliseconds_of(const std::function<void()>& run) {
    const Stopwatch watch;
    run();
    return 1e3 * watch.seconds();
}

double median(std::vector<double> values) {
    CHECK(!values.empty());
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::string range_text(const std::vector<double>& runs_ms, int decimals) {
    if (runs_ms.empty()) return "-";
    const auto [low, high] = std::minmax_element(runs_ms.begin(), runs_ms.end());
    return fmt::format("{0:.{3}f} ({1:.{3}f} to {2:.{3}f})", median(runs_ms), *low, *high, decimals);
}

std::string range_fields(const std::vector<double>& runs_ms) {
    if (runs_ms.empty()) return ",,,";
    const auto [low, high] = std::minmax_element(runs_ms.begin(), runs_ms.end());
    return fmt::format("{:.4f},{:.4f},{:.4f},", median(runs_ms), *low, *high);
}

}  // namespace obscura
