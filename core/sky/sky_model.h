#pragma once
// The kinds of sky that this room knows, as one.

#include <variant>
#include <vector>

#include "core/sky/clear_sky.h"
#include "core/sky/image_sky.h"
#include "core/sky/overcast_sky.h"
#include "core/sky/sky_directions.h"

namespace obscura {

using SkyModel = std::variant<ClearSky, OvercastSky, ImageSky>;

/// Radiance from a unit direction in W/(m2 sr) per channel, the sun's disc left out of clear skies.
Vec3f sky_radiance(const SkyModel& sky, Vec3d direction);

/// See sky_directions.h; a gradient or any other sky comes as a function.
SkyGrid sky_grid(const SkyModel& sky, const Exec& exec);
std::vector<SkyDirection> sky_directions(const SkyModel& sky, int count, SkyImportance importance,
                                         const Exec& exec);

}  // namespace obscura
