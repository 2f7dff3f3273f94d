#pragma once
// The far shadows of a day: a bit for each sample and sun, in units of one tile and some suns that decode
// alone.
//
// Chajdas, Reichl, Dick, Westermann, "High-Quality Shadows for Streaming Terrain Rendering" (Eurographics
// 2014, short papers): a lookup asks the far bit first, and where it is not set, a ray of at most `threshold`
// lines. Here a whole shadow is lossless at samples: far or near is what sweep_shadows() gives for threshold
// 0.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/isa.h"
#include "hierarchy/terrain/tile_bits.h"
#include "raster/heights/height_field.h"
#include "raster/heights/height_sun.h"
#include "raster/heights/shadow_bits.h"

namespace obscura {

/// A sun of a day: when it stands there, and for how long it stands for the sun (core/sun_path.h). Degrees
/// are for readers; shadows are those of `direction`.
struct FarSun {
    double hour_h = 0, hours = 0;
    double azimuth_deg = 0, elevation_deg = 0;
    HeightSun direction;
    friend bool operator==(const FarSun&, const FarSun&) = default;
};

constexpr int largest_far_tile_side = 8192;

struct FarDayParams {
    int threshold = 16;      ///< lines; >= 1
    int tile_side = 512;     ///< samples, a multiple of 64 up to 8192
    int suns_per_unit = 16;  ///< maps that decode together, each by the one before; 1 to 64
    friend bool operator==(const FarDayParams&, const FarDayParams&) = default;
};

/// The grid that a day's maps belong to.
struct FarGrid {
    int width = 0, height = 0;
    double cell_x_m = 1, cell_y_m = 1;
    Diagonal diagonal = Diagonal::falling;
    friend bool operator==(const FarGrid&, const FarGrid&) = default;
};

/// Bytes of one unit within FarDay::bytes.
struct FarUnit {
    std::uint64_t offset = 0, bytes = 0;
    std::uint64_t hash = 0;  ///< bulk_hash of them
    friend bool operator==(const FarUnit&, const FarUnit&) = default;
};

/// Of units that a part of a day has not. No bytes have another hash.
constexpr std::uint64_t absent_unit_hash = 0;

/// Immutable. Units are numbered by groups of suns, and within a group by tiles in rows.
struct FarDay {
    FarGrid grid;
    FarDayParams params;
    std::vector<FarSun> suns;
    std::vector<FarUnit> units;
    std::span<const std::uint8_t> bytes;  ///< of all units
    std::shared_ptr<const void> owner;    ///< of the bytes

    int tiles_x() const { return (grid.width + params.tile_side - 1) / params.tile_side; }
    int tiles_y() const { return (grid.height + params.tile_side - 1) / params.tile_side; }
    int tiles() const { return tiles_x() * tiles_y(); }
    int groups() const {
        return (static_cast<int>(suns.size()) + params.suns_per_unit - 1) / params.suns_per_unit;
    }
    TileArea area(int tile) const;
    /// Suns [first, first + count) of a group.
    struct Suns {
        int first = 0, count = 0;
    };
    Suns suns_of(int group) const;
};

/// Who wants to know how far it is, and may stop it.
struct FarDayWatch {
    std::function<void(int suns_done)> progress;  ///< called from one thread
    const std::atomic<bool>* cancel = nullptr;    ///< when set, what is returned has no units
};

/// The far shadows of `field` under all suns, in lines. Where a sample and its eight neighbours are shadowed
/// by ground nearer than params.threshold lines anyway, its far bit is of no account, and is whatever is
/// cheap. Memory: four maps for each sun of a unit, beside the result.
FarDay make_far_day(const HeightField& field, std::span<const FarSun> suns, const FarDayParams& params,
                    const Exec& exec, const FarDayWatch& watch = {});

/// The day that has all this but units.
FarDay empty_far_day(const HeightField& field, std::span<const FarSun> suns, const FarDayParams& params);

/// The bytes of a group's units by tile; none when it is not there.
using CodedGroup = std::vector<std::vector<std::uint8_t>>;

/// One group of `day`, whose own units are not asked; none when cancelled.
CodedGroup make_far_group(const HeightField& field, const FarDay& day, int group, const Exec& exec,
                          const std::atomic<bool>* cancel = nullptr);

/// The day `like`, with these units in place of its own.
FarDay with_groups(const FarDay& like, std::span<const CodedGroup> groups);

/// Whether the bytes of all units are those that were written, by their checksums; nothing is decoded.
bool is_intact(const FarDay& day);

/// The maps of one unit, sun after sun. Throws InputError, naming `name`, when its bytes are not those that
/// were written.
std::vector<TileBits> far_tile(const FarDay& day, int group, int tile,
                               const std::string& name = "far shadows");

/// The maps of all suns of a group, whole.
std::vector<ShadowBits> far_maps(const FarDay& day, int group, const Exec& exec,
                                 const std::string& name = "far shadows");

/// Whole shadows of a sun: the far map, and where it has no bit, a near ray. `map` is of the same grid as
/// `field`.
ShadowBits with_near_shadows(const HeightField& field, const FarSun& sun, const ShadowBits& map,
                             int threshold);

/// A hash of all that make_far_day() makes its result from, for the key of its file.
std::uint64_t far_day_hash(const HeightField& field, std::span<const FarSun> suns,
                           const FarDayParams& params);

}  // namespace obscura
