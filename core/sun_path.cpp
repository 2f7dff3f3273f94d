#include "core/sun_path.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/num.h"

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

namespace {

/// Where the tip of the shadow of a rod of 1 m lies, in metres.
struct Tip {
    double east = 0, north = 0;
};

Tip tip_of(const SunPosition& sun) {
    const double length = num::cos_deg(sun.apparent_elevation_deg) / num::sin_deg(sun.apparent_elevation_deg);
    return {-length * num::sin_deg(sun.azimuth_deg), -length * num::cos_deg(sun.azimuth_deg)};
}

/// A short part of a path with the sun high enough at both ends, and what lies before it of such parts.
struct TravelPart {
    double from_h, to_h;
    double travel_before, travel_after, hours_before;
};

std::vector<TravelPart> travel_parts(const SunPath& path, double least_elevation_deg) {
    constexpr int parts = 4096;
    std::vector<TravelPart> found;
    double travel = 0, hours = 0;
    SunPosition before = sun_at(path, path.from_h);
    double from = path.from_h;
    for (int i = 1; i <= parts; ++i) {
        const double to = i < parts ? path.from_h + (path.to_h - path.from_h) * i / parts : path.to_h;
        const SunPosition now = sun_at(path, to);
        if (std::min(before.apparent_elevation_deg, now.apparent_elevation_deg) >= least_elevation_deg) {
            const Tip a = tip_of(before), b = tip_of(now);
            const double east = b.east - a.east, north = b.north - a.north;
            const double more = std::sqrt(std::sqrt(east * east + north * north) * (to - from));
            found.push_back({from, to, travel, travel + more, hours});
            travel += more;
            hours += to - from;
        }
        before = now;
        from = to;
    }
    return found;
}

/// When so much of the travel is done, and after how many hours of sun.
struct TravelTime {
    double hour_h, hours;
};

TravelTime time_of(const std::vector<TravelPart>& parts, double travel) {
    const auto at = std::lower_bound(parts.begin(), parts.end() - 1, travel,
                                     [](const TravelPart& p, double t) { return p.travel_after < t; });
    const double length = at->travel_after - at->travel_before;
    const double share = length > 0 ? std::clamp((travel - at->travel_before) / length, 0.0, 1.0) : 0.0;
    const double into = share * (at->to_h - at->from_h);
    return {at->from_h + into, at->hours_before + into};
}

}  // namespace

std::vector<SunStep> sun_steps_by_travel(const SunPath& path, double least_elevation_deg) {
    CHECK(path.from_h < path.to_h && path.steps >= 1);
    CHECK(least_elevation_deg > 0 && least_elevation_deg < 90);
    const std::vector<TravelPart> parts = travel_parts(path, least_elevation_deg);
    std::vector<SunStep> suns;
    if (parts.empty()) return suns;
    const double whole = parts.back().travel_after;
    for (int i = 0; i < path.steps; ++i) {
        const TravelTime begin = time_of(parts, whole * i / path.steps);
        const TravelTime middle = time_of(parts, whole * (i + 0.5) / path.steps);
        const TravelTime end = time_of(parts, whole * (i + 1) / path.steps);
        const SunPosition sun = sun_at(path, middle.hour_h);
        suns.push_back({middle.hour_h, sun.azimuth_deg, sun.apparent_elevation_deg, end.hours - begin.hours});
    }
    return suns;
}

}  // namespace obscura
