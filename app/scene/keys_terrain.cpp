// [[terrain]].

#include "app/scene/key_ranges.h"
#include "app/scene/key_row.h"
#include "app/scene/keys.h"
#include "app/scene/terrain.h"

namespace obscura {
namespace {

constexpr Word<HolePolicy> hole_words[] = {
    {"refuse", HolePolicy::refuse}, {"fill", HolePolicy::fill}, {"level", HolePolicy::level}};

constexpr Range cell_range{1e-3, 1e6};

const KeyRows<ElevationOptions>& elevation_rows() {
    using O = ElevationOptions;
    static const KeyRows<O> rows{
        {number_key("cell_x_m",
                    "Between columns, where the file does not say or is wrong; alone, for rows as well.")
             .in(cell_range)},
        {number_key("cell_y_m", "Between rows; alone, for columns as well.").in(cell_range)},
        {number_key("z_step_m",
                    "Metres in one unit of the file's numbers; PNG and PGM without a JSON need it.")
             .in({1e-6, 1e3})},
        {number_key("latitude_deg", "Of the model's middle: its cells are degrees.").in({-89.9, 89.9})},
        key_row(&O::exaggeration,
                number_key("vertical_exaggeration", "Heights are multiplied by it.").in({1e-3, 1e3})),
        key_row(&O::hole_level_m, number_key("hole_level_m", "With holes = \"level\".").in({-12000, 12000})),
        {choice_key("holes", names_of(hole_words),
                    "Samples without a height: an error, filled from around them, or all at hole_level_m.")
             .or_else("refuse")},
    };
    return rows;
}

const KeyRows<HeightMeshParams>& place_rows() {
    using P = HeightMeshParams;
    static const KeyRows<P> rows{
        key_row(&P::middle_m,
                vec3_key("translate_m", "Where height 0 of the model's middle stands. North is -Z.")
                    .in(key_ranges::anywhere)),
        key_row(&P::skirt_m,
                number_key("skirt_m", "Walls along its border go down so far below the lowest height.")
                    .in({1e-3, 1e6})),
    };
    return rows;
}

const KeyRows<TerrainOptions>& option_rows() {
    static const KeyRows<TerrainOptions> rows{
        key_row(&TerrainOptions::casts_shadow, boolean_key("casts_shadow", "false: light passes through.")),
    };
    return rows;
}

}  // namespace

const TableSpec& terrain_table() {
    static const TableSpec spec = [] {
        TableSpec t{
            "[[terrain]]",
            "Ground from an elevation model: triangles between its samples, closed by walls and a floor.",
            {},
            "",
            {}};
        t.keys = {
            name_key("id", "Name, unique among terrains.").need(),
            file_key("file",
                     "PGM with a JSON beside it, ESRI ASCII grid (.asc), SRTM (.hgt), GeoTIFF (.tif) or "
                     "16-bit PNG; row 0 is in the north.")
                .need(),
            name_key("material",
                     "A [material.NAME], whose texture covers the model once; without it, colours by height "
                     "and slope."),
        };
        for (auto keys : {keys_of(elevation_rows()), keys_of(place_rows()), keys_of(option_rows())}) {
            for (KeySpec& key : keys)
                t.keys.push_back(std::move(key));
        }
        return t;
    }();
    return spec;
}

TerrainOptions terrain_options_of(const SceneTable& terrain, const Limits& limits) {
    TerrainOptions o;
    o.elevation.max_bytes = limits.memory_mib << 20;
    o.elevation.advice = " (limits.memory_mib)";
    read_rows(elevation_rows(), terrain, o.elevation);
    read_rows(place_rows(), terrain, o.mesh);
    read_rows(option_rows(), terrain, o);
    const auto given = [&](const char* key, std::optional<double>& to) {
        if (terrain.has(key)) to = number(terrain, key);
    };
    given("cell_x_m", o.elevation.cell_x_m);
    given("cell_y_m", o.elevation.cell_y_m);
    given("z_step_m", o.elevation.z_step_m);
    given("latitude_deg", o.elevation.latitude_deg);
    o.elevation.holes = value_named(hole_words, text(terrain, "holes"));
    return o;
}

}  // namespace obscura
