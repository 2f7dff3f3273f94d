#pragma once
// The sun's way over a part of a day, as a row of suns that stand for it.

#include <vector>

#include "core/sun.h"

namespace obscura {

/// From one time of a day to a later one, at a place. Hours are those of a clock, from midnight of its date.
struct SunPath {
    int year = 2000, month = 1, day = 1;  ///< by the clock; is_solar_date()
    double ahead_of_utc_h = 0;            ///< the clock
    double from_h = 0, to_h = 24;         ///< from_h < to_h
    double latitude_deg = 0, longitude_deg = 0;
    int steps = 144;  ///< parts of equal length
    friend bool operator==(const SunPath&, const SunPath&) = default;
};

/// A part of a path, hours as there.
struct SunSpan {
    double from_h = 0, to_h = 0;
    double hours() const { return to_h - from_h; }
};

/// When the sun is up: its middle, as seen through standard air, above the horizon of level ground, which is
/// what a light of type "sun" calls up. Rise and set are found by bisection, to rounding; the sun up (or
/// down) for less than a minute may be missed. In order; none where it stays below.
std::vector<SunSpan> sunlit_spans(const SunPath& path);

/// A sun that stands for a part of the path.
struct SunStep {
    double hour_h = 0;                          ///< when it stands there, the middle of the part
    double azimuth_deg = 0, elevation_deg = 0;  ///< through air, above 0
    double hours = 0;                           ///< of the part
};

/// A sun for each of the path's steps, at the middle of what is sunlit of it, and hours that add up to the
/// spans': parts are whole but at sunrise and sunset. Steps without sun are left out, and one in which it
/// sets and rises again is two.
std::vector<SunStep> sun_steps(const SunPath& path);

/// path.steps suns, close together where shadows move fast: the steps have equal shares of the integral of
/// the square root of the speed at which the tip of an upright rod's shadow moves over level ground, while
/// the sun stands at least least_elevation_deg in (0, 90) high, through air. The root is a compromise: by the
/// speed itself nearly all suns would stand at the horizon. Each stands at the middle of its part's travel;
/// hours add up to the time that the sun is so high, in whole 4096ths of the path. None where it stays lower.
std::vector<SunStep> sun_steps_by_travel(const SunPath& path, double least_elevation_deg);

}  // namespace obscura
