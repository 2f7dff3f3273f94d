#include "core/sun_path.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

constexpr double minutes_per_hour = 60;

SunPosition sun_at(const SunPath& path, double hour) {
    return solar_position(path.year, path.month, path.day, hour - path.ahead_of_utc_h, path.latitude_deg,
                          path.longitude_deg);
}

bool is_up(const SunPath& path, double hour) {
    return sun_at(path, hour).apparent_elevation_deg > 0;
}

/// Between two times of which one has the sun up: the last of the earlier kind, to the last bit.
double change_between(const SunPath& path, double before, double after) {
    const bool up_before = is_up(path, before);
    while (true) {
        const double middle = before + 0.5 * (after - before);
        if (middle <= before || middle >= after) return before;
        (is_up(path, middle) == up_before ? before : after) = middle;
    }
}

}  // namespace

std::vector<SunSpan> sunlit_spans(const SunPath& path) {
    CHECK(path.from_h < path.to_h && path.steps >= 1);
    const double length = path.to_h - path.from_h;
    const auto minutes = static_cast<int>(std::ceil(length * minutes_per_hour));
    std::vector<SunSpan> spans;
    double before = path.from_h;
    bool up = is_up(path, before);
    if (up) spans.push_back({before, path.to_h});
    for (int i = 1; i <= minutes; ++i) {
        const double now = i < minutes ? path.from_h + length * i / minutes : path.to_h;
        const bool up_now = is_up(path, now);
        if (up_now && !up) spans.push_back({change_between(path, before, now), path.to_h});
        if (up && !up_now) spans.back().to_h = change_between(path, before, now);
        before = now;
        up = up_now;
    }
    return spans;
}

std::vector<SunStep> sun_steps(const SunPath& path) {
    const std::vector<SunSpan> spans = sunlit_spans(path);
    const double length = path.to_h - path.from_h;
    std::vector<SunStep> suns;
    for (int i = 0; i < path.steps; ++i) {
        const double begin = path.from_h + length * i / path.steps;
        const double end = i + 1 < path.steps ? path.from_h + length * (i + 1) / path.steps : path.to_h;
        for (const SunSpan& span : spans) {
            const SunSpan part{std::max(begin, span.from_h), std::min(end, span.to_h)};
            if (part.from_h >= part.to_h) continue;
            const double middle = part.from_h + 0.5 * part.hours();
            const SunPosition sun = sun_at(path, middle);
            // Of a part a few bits long the middle may be its end.
            if (sun.apparent_elevation_deg <= 0) continue;
            suns.push_back({middle, sun.azimuth_deg, sun.apparent_elevation_deg, part.hours()});
        }
    }
    return suns;
}

}  // namespace obscura
