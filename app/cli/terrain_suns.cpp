#include "app/cli/terrain_suns.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "core/sun.h"

namespace obscura {

std::vector<FarSun> suns_of_day(const HeightField& field, SunPath path, int count,
                                double least_elevation_deg) {
    path.steps = count;
    std::vector<FarSun> suns;
    for (const SunStep& s : sun_steps_by_travel(path, least_elevation_deg)) {
        suns.push_back({s.hour_h, s.hours, s.azimuth_deg, s.elevation_deg,
                        height_sun(field, s.azimuth_deg, s.elevation_deg)});
    }
    return suns;
}

FarSun sun_at_hour(const HeightField& field, const SunPath& path, double hour_h) {
    const SunPosition sun = solar_position(path.year, path.month, path.day, hour_h - path.ahead_of_utc_h,
                                           path.latitude_deg, path.longitude_deg);
    FarSun s{hour_h, 0, sun.azimuth_deg, sun.apparent_elevation_deg, {}};
    if (s.elevation_deg > 0) s.direction = height_sun(field, s.azimuth_deg, s.elevation_deg);
    return s;
}

std::string time_text(const SunPath& path, double hour_h) {
    const auto ms = static_cast<std::int64_t>(std::floor(hour_h * 3'600'000 + 0.5));
    const auto ahead = static_cast<std::int64_t>(std::floor(std::fabs(path.ahead_of_utc_h) * 60 + 0.5));
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}{}{:02}:{:02}", path.year, path.month,
                       path.day, ms / 3'600'000, ms / 60'000 % 60, ms / 1000 % 60, ms % 1000,
                       path.ahead_of_utc_h < 0 ? '-' : '+', ahead / 60, ahead % 60);
}

std::string sun_list_text(const SunPath& path, std::span<const FarSun> suns) {
    std::string out = "time,azimuth_deg,elevation_deg,hours\n";
    for (const FarSun& s : suns) {
        out += fmt::format("{},{:.6f},{:.6f},{:.6f}\n", time_text(path, s.hour_h), s.azimuth_deg,
                           s.elevation_deg, s.hours);
    }
    return out;
}

}  // namespace obscura
