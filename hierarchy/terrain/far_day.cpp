#include "hierarchy/terrain/far_day.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "hierarchy/terrain/far_code.h"
#include "raster/heights/height_near.h"
#include "raster/heights/height_sweep.h"

namespace obscura {
namespace {

/// Far shadows of one sun, and where they count.
struct CodedMap {
    ShadowBits far_bits, cares;
};

CodedMap coded_map(const HeightField& field, const HeightSun& sun, int threshold) {
    const int thresholds[] = {0, threshold};
    std::vector<ShadowBits> maps = sweep_shadows(field, sun, thresholds);
    // Where there is no far shadow, a whole one is near; elsewhere a ray tells.
    ShadowBits in_near = near_shadows(field, sun, threshold, maps[1]);
    for (std::size_t i = 0; i < in_near.words.size(); ++i)
        in_near.words[i] |= maps[0].words[i] & ~maps[1].words[i];
    ShadowBits cares = eroded(in_near);
    for (std::uint64_t& word : cares.words)
        word = ~word;
    return {std::move(maps[1]), std::move(cares)};
}

/// A unit's maps as tiles.
std::vector<TileBits> tiles_of(const std::vector<CodedMap>& maps, ShadowBits CodedMap::*which,
                               const TileArea& area) {
    std::vector<TileBits> tiles;
    tiles.reserve(maps.size());
    for (const CodedMap& map : maps)
        tiles.push_back(tile_of(map.*which, area));
    return tiles;
}

void check_params(const FarDayParams& p) {
    CHECK(p.threshold >= 1 && p.tile_side >= 64 && p.tile_side % 64 == 0 &&
          p.tile_side <= largest_far_tile_side);
    CHECK(p.suns_per_unit >= 1 && p.suns_per_unit <= 64);
}

}  // namespace

TileArea FarDay::area(int tile) const {
    const int x = tile % tiles_x() * params.tile_side, y = tile / tiles_x() * params.tile_side;
    return {x, y, std::min(params.tile_side, grid.width - x), std::min(params.tile_side, grid.height - y)};
}

FarDay::Suns FarDay::suns_of(int group) const {
    const int first = group * params.suns_per_unit;
    return {first, std::min(params.suns_per_unit, static_cast<int>(suns.size()) - first)};
}

FarDay empty_far_day(const HeightField& field, std::span<const FarSun> suns, const FarDayParams& params) {
    check_height_field(field);
    check_params(params);
    FarDay day;
    day.grid = {field.width(), field.height(), field.cell_x_m, field.cell_y_m, field.diagonal};
    day.params = params;
    day.suns.assign(suns.begin(), suns.end());
    day.units.assign(static_cast<std::size_t>(day.groups()) * static_cast<std::size_t>(day.tiles()),
                     {0, 0, absent_unit_hash});
    return day;
}

CodedGroup make_far_group(const HeightField& field, const FarDay& day, int group, const Exec& exec,
                          const std::atomic<bool>* cancel) {
    const FarDay::Suns part = day.suns_of(group);
    std::vector<CodedMap> maps(static_cast<std::size_t>(part.count));
    parallel_for(maps.size(), exec, [&](std::size_t i) {
        if (stopped(cancel)) return;
        const FarSun& sun = day.suns[static_cast<std::size_t>(part.first) + i];
        maps[i] = coded_map(field, sun.direction, day.params.threshold);
    });
    if (stopped(cancel)) return {};
    CodedGroup coded(static_cast<std::size_t>(day.tiles()));
    parallel_for(coded.size(), exec, [&](std::size_t tile) {
        const TileArea area = day.area(static_cast<int>(tile));
        coded[tile] = encode_far_tile(tiles_of(maps, &CodedMap::far_bits, area),
                                      tiles_of(maps, &CodedMap::cares, area));
    });
    return coded;
}

FarDay make_far_day(const HeightField& field, std::span<const FarSun> suns, const FarDayParams& params,
                    const Exec& exec, const FarDayWatch& watch) {
    FarDay day = empty_far_day(field, suns, params);
    std::vector<CodedGroup> groups;
    for (int group = 0; group < day.groups(); ++group) {
        groups.push_back(make_far_group(field, day, group, exec, watch.cancel));
        if (groups.back().empty()) {
            day.units.clear();
            return day;
        }
        const FarDay::Suns part = day.suns_of(group);
        if (watch.progress) watch.progress(part.first + part.count);
    }
    return with_groups(day, groups);
}

FarDay with_groups(const FarDay& like, std::span<const CodedGroup> groups) {
    CHECK(static_cast<int>(groups.size()) == like.groups());
    FarDay day = like;
    day.units.clear();
    auto bytes = std::make_shared<std::vector<std::uint8_t>>();
    for (const CodedGroup& group : groups) {
        CHECK(group.empty() || static_cast<int>(group.size()) == day.tiles());
        for (const std::vector<std::uint8_t>& unit : group) {
            day.units.push_back({bytes->size(), unit.size(), bulk_hash(unit.data(), unit.size())});
            bytes->insert(bytes->end(), unit.begin(), unit.end());
        }
        if (group.empty()) {
            day.units.insert(day.units.end(), static_cast<std::size_t>(day.tiles()),
                             {bytes->size(), 0, absent_unit_hash});
        }
    }
    day.bytes = *bytes;
    day.owner = bytes;
    return day;
}

namespace {

bool is_intact(const FarDay& day, const FarUnit& unit) {
    const auto bytes = day.bytes.subspan(unit.offset, unit.bytes);
    return bulk_hash(bytes.data(), bytes.size()) == unit.hash;
}

}  // namespace

bool is_intact(const FarDay& day) {
    return std::all_of(day.units.begin(), day.units.end(),
                       [&](const FarUnit& unit) { return is_intact(day, unit); });
}

std::vector<TileBits> far_tile(const FarDay& day, int group, int tile, const std::string& name) {
    CHECK(group >= 0 && group < day.groups() && tile >= 0 && tile < day.tiles());
    const FarUnit& unit = day.units[static_cast<std::size_t>(group) * static_cast<std::size_t>(day.tiles()) +
                                    static_cast<std::size_t>(tile)];
    const auto bytes = day.bytes.subspan(unit.offset, unit.bytes);
    if (!is_intact(day, unit)) {
        throw InputError(
            name, fmt::format("is altered: the checksum of tile {} of suns {} and following differs", tile,
                              day.suns_of(group).first));
    }
    return decode_far_tile(bytes, day.area(tile), day.suns_of(group).count);
}

std::vector<ShadowBits> far_maps(const FarDay& day, int group, const Exec& exec, const std::string& name) {
    const auto count = static_cast<std::size_t>(day.suns_of(group).count);
    std::vector<ShadowBits> maps(count, ShadowBits(day.grid.width, day.grid.height));
    // Tiles begin at whole words, so those beside each other write to different ones.
    parallel_for(static_cast<std::size_t>(day.tiles()), exec, [&](std::size_t tile) {
        const std::vector<TileBits> tiles = far_tile(day, group, static_cast<int>(tile), name);
        for (std::size_t i = 0; i < count; ++i)
            put_tile(tiles[i], day.area(static_cast<int>(tile)), maps[i]);
    });
    return maps;
}

ShadowBits with_near_shadows(const HeightField& field, const FarSun& sun, const ShadowBits& map,
                             int threshold) {
    CHECK(map.width == field.width() && map.height == field.height());
    ShadowBits lit = map;
    for (std::uint64_t& word : lit.words)
        word = ~word;
    return united(map, near_shadows(field, sun.direction, threshold, lit));
}

std::uint64_t far_day_hash(const HeightField& field, std::span<const FarSun> suns,
                           const FarDayParams& params) {
    const auto& heights = field.height_q16.pixels;
    Hasher h;
    h.value(bulk_hash(heights.data(), heights.size() * sizeof heights[0]))
        .value(field.width())
        .value(field.height());
    h.value(field.cell_x_m).value(field.cell_y_m).value(field.diagonal).value(params);
    for (const FarSun& s : suns) {
        const HeightSun& d = s.direction;
        h.value(s.hour_h)
            .value(s.hours)
            .value(s.azimuth_deg)
            .value(s.elevation_deg)
            .value(d.slope_q20)
            .value(d.rise_q36);
        h.value(d.lines_are_columns).value(d.step_line).value(d.step_along);
    }
    return h.state;
}

}  // namespace obscura
