#pragma once
// Pictures of the ground's shadows at hours of a day.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/sun_path.h"
#include "hierarchy/terrain/far_day.h"

namespace obscura {

/// A picture to make: its sun, and its file.
struct ShadowPicture {
    FarSun sun;
    std::filesystem::path file;
};

/// "shadow_####.png" at 07:30: "shadow_0730.png". Seconds follow when there are any.
std::filesystem::path shadow_file(const std::filesystem::path& pattern, double hour_h);

/// One for each of `hours_h`; when there are none, for each whole hour of the path in which the sun stands at
/// least least_elevation_deg high. A time in which it is below the horizon is a UsageError.
std::vector<ShadowPicture> shadow_pictures(const HeightField& field, const SunPath& path,
                                           std::span<const double> hours_h, double least_elevation_deg,
                                           const std::filesystem::path& pattern);

/// Grey: white where all of the sun is seen, black where none is.
std::string shadow_png(const Image<float>& shares);

}  // namespace obscura
