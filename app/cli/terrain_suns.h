#pragma once
// The suns that a day over ground is made of.

#include <span>
#include <string>
#include <vector>

#include "core/sun_path.h"
#include "hierarchy/terrain/far_day.h"

namespace obscura {

/// Of `count` steps of the path, close together where shadows move fast; none lower than least_elevation_deg.
std::vector<FarSun> suns_of_day(const HeightField& field, SunPath path, int count,
                                double least_elevation_deg);

/// The sun at a time of the path's day, standing for no hours.
FarSun sun_at_hour(const HeightField& field, const SunPath& path, double hour_h);

/// "2026-06-21T07:10:03.250+02:00": the clock of the path, as `time` of a scene's light takes it.
std::string time_text(const SunPath& path, double hour_h);

/// A line for each sun under a line of names: CSV.
std::string sun_list_text(const SunPath& path, std::span<const FarSun> suns);

}  // namespace obscura
