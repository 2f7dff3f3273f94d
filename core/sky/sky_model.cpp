// One row per kind of sky.

#include "core/sky/sky_model.h"

namespace obscura {

Vec3f sky_radiance(const SkyModel& sky, Vec3d direction) {
    return std::visit([&](const auto& kind) { return sky_radiance(kind, direction); }, sky);
}

SkyGrid sky_grid(const SkyModel& sky, const Exec& exec) {
    if (const auto* image = std::get_if<ImageSky>(&sky)) return sky_grid(*image);
    return sky_grid([&](Vec3d direction) { return sky_radiance(sky, direction); }, exec);
}

std::vector<SkyDirection> sky_directions(const SkyModel& sky, int count, SkyImportance importance,
                                         const Exec& exec) {
    return sky_directions(sky_grid(sky, exec), count, importance);
}

}  // namespace obscura
