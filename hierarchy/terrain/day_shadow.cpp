#include "hierarchy/terrain/day_shadow.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/num.h"

namespace obscura {
namespace {

/// Of the triangle around a place, the weight of those of its samples whose far bit is set.
double far_weight(const DaySun& sun, const GroundPlace& place) {
    const double u = place.right, v = place.down;
    const auto bit = [&](int x, int y, double weight) {
        return sun.far_bits(place.cell_x + x, place.cell_y + y) ? weight : 0.0;
    };
    if (sun.ground->day.grid.diagonal == Diagonal::falling) {
        if (u >= v) return bit(0, 0, 1 - u) + bit(1, 0, u - v) + bit(1, 1, v);
        return bit(0, 0, 1 - v) + bit(0, 1, v - u) + bit(1, 1, u);
    }
    if (u + v <= 1) return bit(0, 0, 1 - u - v) + bit(1, 0, u) + bit(0, 1, v);
    return bit(1, 1, u + v - 1) + bit(0, 1, 1 - u) + bit(1, 0, 1 - v);
}

}  // namespace

bool is_of_ground(const FarDay& day, std::uint64_t hash, const HeightField& field) {
    const FarGrid grid{field.width(), field.height(), field.cell_x_m, field.cell_y_m, field.diagonal};
    return day.grid == grid && far_day_hash(field, day.suns, day.params) == hash;
}

NearestSun nearest_sun(const FarDay& day, Vec3d to_sun) {
    NearestSun nearest;
    double least = 5;
    for (std::size_t i = 0; i < day.suns.size(); ++i) {
        const FarSun& s = day.suns[i];
        const double level = num::cos_deg(s.elevation_deg);
        const Vec3d way{level * num::sin_deg(s.azimuth_deg), num::sin_deg(s.elevation_deg),
                        -level * num::cos_deg(s.azimuth_deg)};
        const double chord = length(way - to_sun);
        if (chord >= least) continue;
        least = chord;
        nearest.sun = static_cast<int>(i);
    }
    if (nearest.sun >= 0) nearest.degrees = 2 * num::asin(std::min(1.0, least / 2)) * (180 / num::pi);
    return nearest;
}

std::shared_ptr<const DaySun> day_sun(std::shared_ptr<const GroundDay> ground, int sun, const Exec& exec) {
    CHECK(sun >= 0 && sun < static_cast<int>(ground->day.suns.size()));
    const int group = sun / ground->day.params.suns_per_unit;
    std::vector<ShadowBits> maps = far_maps(ground->day, group, exec, ground->name);
    const auto at = static_cast<std::size_t>(sun - ground->day.suns_of(group).first);
    const HeightRays rays(*ground->field, ground->pyramid,
                          ground->day.suns[static_cast<std::size_t>(sun)].direction);
    return std::make_shared<const DaySun>(DaySun{std::move(ground), sun, std::move(maps[at]), rays});
}

std::int64_t day_sun_bytes(std::int64_t samples) {
    // A bit for each, and a height for each block of the pyramid.
    return samples / 8 + samples * 4 / 63 + 4096;
}

std::int64_t day_decoding_bytes(std::int64_t samples) {
    // Up to 64 maps decode together, whole and in tiles.
    return samples / 8 * 2 * 64;
}

bool ground_dark(const DaySun& sun, const GroundPlace& place, HeightRayCounts* counts) {
    if (far_weight(sun, place) >= 0.5) return true;
    return sun.rays.ground_hidden(place, sun.ground->day.params.threshold, counts);
}

}  // namespace obscura
