#pragma once
// A day's far shadows as pictures ask them: far bits of the ground's samples, then a ray of at most so many
// lines as the day's threshold (Chajdas, Reichl, Dick, Westermann 2014, section 3.3).

#include <cstdint>
#include <memory>
#include <string>

#include "core/isa.h"
#include "core/vec.h"
#include "hierarchy/terrain/far_day.h"
#include "raster/heights/height_pyramid.h"
#include "raster/heights/height_rays.h"

namespace obscura {

/// A day and the ground that it is of.
struct GroundDay {
    std::shared_ptr<const HeightField> field;
    HeightPyramid pyramid;
    FarDay day;
    std::string name;  ///< of its file
};

/// Whether `day` was made of this ground: the key of its file is far_day_hash() of it, of the file's own suns
/// and settings.
bool is_of_ground(const FarDay& day, std::uint64_t hash, const HeightField& field);

/// A sun of the day, and how far it stands from another direction.
struct NearestSun {
    int sun = -1;  ///< none where the day has no suns
    double degrees = 180;
};
/// to_sun: unit, x east, y up, z south.
NearestSun nearest_sun(const FarDay& day, Vec3d to_sun);

/// The far bits of one sun, decoded.
struct DaySun {
    std::shared_ptr<const GroundDay> ground;
    int sun = 0;
    ShadowBits far_bits;
    HeightRays rays;
};

/// Decodes the sun's map, and those of its unit meanwhile. Throws InputError naming the file when it is
/// altered.
std::shared_ptr<const DaySun> day_sun(std::shared_ptr<const GroundDay> ground, int sun, const Exec& exec);

/// Bytes that a day of so many samples takes beside its file and its ground, with one sun decoded; and what
/// decoding takes meanwhile.
std::int64_t day_sun_bytes(std::int64_t samples);
std::int64_t day_decoding_bytes(std::int64_t samples);

/// Whether the sun is hidden from a place on the ground. At a sample that is the whole shadow, bit for bit.
/// Between samples the far bits of its triangle's three count by barycentric coordinates, half and more being
/// dark, so that edges of far shadows are straight within triangles; near shadows are those of the surface.
bool ground_dark(const DaySun& sun, const GroundPlace& place, HeightRayCounts* counts = nullptr);

}  // namespace obscura
