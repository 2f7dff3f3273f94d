#pragma once
// A sky as K distant lights: directions where its light comes from, each with its share.

#include <functional>
#include <vector>

#include "core/isa.h"
#include "core/sky/image_sky.h"
#include "core/vec.h"

namespace obscura {

/// Light of the upper hemisphere in square cells of equal solid angle (Shirley and Chiu 1997 onto the disc,
/// Lambert 1772 onto the hemisphere). By channel the vector irradiance of each cell: integral of radiance
/// times direction, W/m2.
struct SkyCell {
    Vec3d red, green, blue;
};
struct SkyGrid {
    static constexpr int side = 256;
    std::vector<SkyCell> cells;  ///< side * side, rows along the square's second axis
};

/// Radiance at the middle of every cell. The function gets unit directions with y > 0 and is called from
/// several threads; values must be finite and not negative.
SkyGrid sky_grid(const std::function<Vec3f(Vec3d)>& radiance, const Exec& exec);

/// Each pixel's light goes to the cells that it covers, in pieces of a third of a cell's side; nothing is
/// lost, however small a sun in the picture is.
SkyGrid sky_grid(const ImageSky& sky);

/// Irradiance of a surface with this unit normal that sees the whole upper hemisphere in front of it, per
/// channel.
Vec3d unoccluded_irradiance(const SkyGrid& grid, Vec3d normal);

/// One distant light. A surface it reaches gets irradiance_w_m2 * max(0, dot(normal, direction)).
struct SkyDirection {
    Vec3d direction{0, 1, 0};   ///< unit, towards the sky, y > 0
    Vec3f irradiance_w_m2;      ///< on a surface that faces it, per channel
    double solid_angle_sr = 0;  ///< of the part of the sky that it stands for
};

/// What makes a part of the sky worth a direction.
///  - radiance: its light; all directions weigh about the same, so no shadow's edge is stronger than another;
///  - root: the square root of its radiance, which makes the sum over all directions most accurate;
///  - cosine: what level ground would get of an even sky, whatever this one is like.
enum class SkyImportance { radiance, root, cosine };

/// `count` directions (16, 64, 256 or 1024): the sky in parts of nearly equal importance, each along the
/// middle of its light with the irradiance of its whole part. They follow a Hilbert curve, so that neighbours
/// in the list are neighbours in the sky. How near the sum of all comes to unoccluded_irradiance(): README.
/// Deterministic.
std::vector<SkyDirection> sky_directions(const SkyGrid& grid, int count, SkyImportance importance);

}  // namespace obscura
