#include "app/cli/terrain_shadows.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "app/cli/terrain_suns.h"
#include "core/error.h"
#include "core/image_io.h"

namespace obscura {

std::filesystem::path shadow_file(const std::filesystem::path& pattern, double hour_h) {
    const auto seconds = static_cast<std::int64_t>(std::floor(hour_h * 3600 + 0.5));
    std::string clock = fmt::format("{:02}{:02}", seconds / 3600, seconds / 60 % 60);
    if (seconds % 60 != 0) clock += fmt::format("{:02}", seconds % 60);
    std::string name = pattern.filename().string();
    const std::size_t at = name.find("####");
    CHECK(at != std::string::npos);
    return pattern.parent_path() / name.replace(at, 4, clock);
}

std::vector<ShadowPicture> shadow_pictures(const HeightField& field, const SunPath& path,
                                           std::span<const double> hours_h, double least_elevation_deg,
                                           const std::filesystem::path& pattern) {
    std::vector<ShadowPicture> pictures;
    for (const double hour : hours_h) {
        const FarSun sun = sun_at_hour(field, path, hour);
        if (!(sun.elevation_deg > 0))
            throw UsageError(
                fmt::format("--shadow-time: at {} the sun is below the horizon", time_text(path, hour)));
        pictures.push_back({sun, shadow_file(pattern, hour)});
    }
    if (!hours_h.empty()) return pictures;
    for (double hour = std::ceil(path.from_h); hour <= path.to_h && hour < 24; ++hour) {
        const FarSun sun = sun_at_hour(field, path, hour);
        if (sun.elevation_deg >= least_elevation_deg) pictures.push_back({sun, shadow_file(pattern, hour)});
    }
    return pictures;
}

std::string shadow_png(const Image<float>& shares) {
    Image<Rgb8> picture(shares.width, shares.height);
    for (std::size_t i = 0; i < shares.pixels.size(); ++i) {
        const auto grey = static_cast<std::uint8_t>(std::floor(shares.pixels[i] * 255 + 0.5f));
        picture.pixels[i] = {grey, grey, grey};
    }
    return encode_png(picture.view());
}

}  // namespace obscura
