#pragma once
// obscura terrain SCENE: the shadows of a day over a scene's elevation model.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "app/cli/scene_run.h"

namespace obscura {

struct TerrainDayOptions {
    SceneRun run;                       ///< stats_json and frames stay empty
    std::string terrain;                ///< id; empty: the scene's first
    std::filesystem::path far_shadows;  ///< where they go; empty: nowhere
    std::filesystem::path hours;        ///< .pfm; empty: nowhere
    std::filesystem::path picture;      ///< of the hours, .png; empty: nowhere
    std::filesystem::path list;         ///< of the suns, .csv; empty: nowhere
    std::filesystem::path shadows;      ///< .png with #### for the time; empty: nowhere
    std::vector<double> shadow_hours;   ///< by the scene's clock; none: every whole hour
    std::int64_t suns = 158;
    std::int64_t threshold = 16;  ///< lines of the grid
    std::int64_t tile_side = 512;
    double least_elevation_deg = 0.5;
    double angular_diameter_deg = 0;  ///< of the sun, in hours and pictures
    bool curvature = false;
    double refraction = 0.13;
    std::int64_t part = 1, parts = 1;           ///< of the far shadows' units
    std::vector<std::filesystem::path> merged;  ///< files of parts
};

/// Prints to standard output what was made. Far shadows that the file has already, from the same ground, suns
/// and settings, are left as they are. Returns the exit code. Throws InputError, LimitError, UsageError,
/// OutputError.
int terrain_command(const TerrainDayOptions& options);

/// The command line of it.
int run_terrain(const Arguments& arguments);

}  // namespace obscura
