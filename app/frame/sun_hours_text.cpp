#include "app/frame/sun_hours_text.h"

#include <fmt/format.h>

#include <cmath>

#include "core/count_text.h"

namespace obscura {
namespace {

/// "04:43", rounded to the minute.
std::string clock_text(double hours) {
    const auto minutes = static_cast<int>(std::floor(hours * 60 + 0.5));
    return fmt::format("{:02}:{:02}", minutes / 60, minutes % 60);
}

std::string spans_text(const std::vector<SunSpan>& sunlit) {
    std::string out;
    for (const SunSpan& span : sunlit)
        out += fmt::format("{}{} to {}", out.empty() ? "" : " and ", clock_text(span.from_h),
                           clock_text(span.to_h));
    return out;
}

}  // namespace

std::string date_text(const SunPath& path) {
    return fmt::format("{:04}-{:02}-{:02}", path.year, path.month, path.day);
}

std::string sun_path_text(const std::string& light, const SunPath& path) {
    SunHoursStats stats;
    stats.sunlit = sunlit_spans(path);
    const std::string up = stats.sunlit.empty()
                               ? "it does not rise"
                               : fmt::format("up {}, {:.2f} h", spans_text(stats.sunlit), stats.sunlit_h());
    return fmt::format("light '{}', {}, {} to {} in {} of {:.3g} min: {}", light, date_text(path),
                       clock_text(path.from_h), clock_text(path.to_h), count_text(path.steps, "step"),
                       (path.to_h - path.from_h) * 60 / path.steps, up);
}

std::string no_sun_text(const std::string& light, const SunPath& path) {
    return fmt::format(
        "light '{}' does not rise at latitude {:g} on {} between {} and {}: there are no hours of sun", light,
        path.latitude_deg, date_text(path), clock_text(path.from_h), clock_text(path.to_h));
}

std::string sun_hours_text(const SunHoursStats& stats, int verbosity) {
    std::string out = fmt::format("  sun hours: {}\n", sun_path_text(stats.light, stats.path));
    if (verbosity == 0) return out;
    return out + fmt::format("  in {:.3f} s, of it putting casters in order {:.3f} s: {}, {}, {} looked up\n",
                             stats.total_s, stats.order_s, count_text(stats.suns, "sun"),
                             count_text(stats.passes, "pass", "passes"),
                             count_text(stats.exact.samples, "sample"));
}

}  // namespace obscura
