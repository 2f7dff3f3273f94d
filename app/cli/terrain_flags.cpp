// The command line of `obscura terrain`.

#include <fmt/format.h>

#include "app/cli/flag_values.h"
#include "app/cli/flags.h"
#include "app/cli/scene_flags.h"
#include "app/cli/terrain_command.h"
#include "app/report/output_plan.h"
#include "app/scene/value.h"
#include "core/error.h"
#include "hierarchy/terrain/far_day.h"

namespace obscura {
namespace {

/// "2/8".
void read_part(const std::string& text, TerrainDayOptions& options) {
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) throw UsageError(fmt::format("--tile: '{}' is not I/N, as 2/8 is", text));
    options.parts = whole_number("--tile", text.substr(slash + 1), 1, 1 << 20);
    options.part = whole_number("--tile", text.substr(0, slash), 1, options.parts);
}

}  // namespace

int run_terrain(const Arguments& arguments) {
    Flags flags("terrain [options] SCENE",
                "The shadows of a day over a scene's [[terrain]], exact at every sample of its elevation "
                "model, along the way of the scene's sun.");
    RunFlags run;
    TerrainDayOptions options;
    std::string far_shadows, hours, picture, list, shadows, part;
    std::vector<std::string> times, merged;
    // Below 0 where they are not given.
    double angular_diameter_deg = -1, refraction = -1;
    flags.positional("SCENE", run.scene.scene, "The scene file (TOML).");
    flags.group("Scene");
    flags.list("-D,--define", "KEY=VALUE", run.scene.overrides,
               "Replace a value of the scene (see 'obscura render --help'); may be given again.");
    flags.list("--allow-path", "DIR", run.scene.allowed,
               "A folder besides the scene's own that its files may lie in; may be given again.");
    flags.text("--terrain", "ID", options.terrain, "Which [[terrain]].", "the first");
    flags.group("Day");
    flags.whole("--suns", "N", options.suns, 1, 4096,
                "Suns over the day, closer together where shadows move fast.", "158");
    flags.number("--least-elevation", "DEG", options.least_elevation_deg, 0.01, 89,
                 "None stands lower, and no hours count in which it does.", "0.5");
    flags.whole("--threshold", "LINES", options.threshold, 1, 1 << 20,
                "Far shadows have casters at least so many lines of the grid away.", "16");
    flags.whole("--tile-side", "SAMPLES", options.tile_side, 64, largest_far_tile_side,
                "Side of a tile of the maps, a multiple of 64.", "512");
    flags.number("--angular-diameter", "DEG", angular_diameter_deg, 0, 90,
                 "Of the sun's disc, for hours and pictures with penumbrae, by the horizon of every sample; "
                 "0.53 is the sun's. Far shadows are of its middle.",
                 "0, hard shadows");
    flags.on_off(
        "--curvature", options.curvature,
        "The ground curves away as the earth does, 8 cm in a kilometre and 785 m in a hundred. For hours and "
        "pictures: far shadows are of a scene's own ground.");
    flags.number("--refraction", "K", refraction, 0, 0.99,
                 "With --curvature: of this share of it light bends along; 0.13 by day.", "0.13");
    flags.group("Output");
    flags.text("-o,--output", "FILE", far_shadows, "Far shadows of all suns, tiles of which decode alone.",
               "none");
    flags.text(
        "--hours", "FILE", hours,
        "Hours of sun of every sample (.pfm), without those in which the sun stands below --least-elevation.",
        "none");
    flags.text("--picture", "FILE", picture, "The same in colours, with a scale (.png).", "none");
    flags.text(
        "--shadows", "FILE", shadows,
        "Shadows at hours of the day, white where the sun is seen (shadow_####.png; #### becomes 0730).",
        "none");
    flags.list("--shadow-time", "HH:MM", times,
               "With --shadows: at this time by the scene's clock; may be given again. Without it, at every "
               "whole hour in which the sun stands high enough.");
    flags.text("--list", "FILE", list, "When the suns stand where, and for how many hours (.csv).", "none");
    flags.group("Parts");
    flags.text(
        "--tile", "I/N", part,
        "Far shadows of part I of N alone, in units of 16 suns; 1/1 is all. What is finished is kept in "
        "FILE.partial, from which the same command goes on after it was stopped.",
        "1/1");
    flags.list("--merge", "FILE", merged,
               "Takes the units of this file of a part; may be given again. A gap, or a part of another day, "
               "is an error.");
    flags.on_off("--overwrite", run.run.overwrite, "Replace files that exist; otherwise they are an error.");
    flags.on_off("-q,--quiet", run.run.quiet, "Say nothing but errors.");
    add_exec_flags(flags, run.threads, run.isa);
    if (!flags.parse(arguments)) return 0;
    if (options.tile_side % 64 != 0) throw UsageError("--tile-side must be a multiple of 64");
    if (!hours.empty() && file_kind(hours) != FileKind::pfm)
        throw UsageError(fmt::format("--hours: '{}' does not end in .pfm", hours));
    if (!picture.empty() && file_kind(picture) != FileKind::png)
        throw UsageError(fmt::format("--picture: '{}' does not end in .png", picture));
    if (!shadows.empty() &&
        (file_kind(shadows) != FileKind::png ||
         std::filesystem::path(shadows).filename().string().find("####") == std::string::npos))
        throw UsageError(
            fmt::format("--shadows: '{}' does not end in .png, or has no #### for the time", shadows));
    if (shadows.empty() && !times.empty()) throw UsageError("--shadow-time needs --shadows");
    if (far_shadows.empty() && !(part.empty() && merged.empty()))
        throw UsageError("--tile and --merge need -o");
    if (!part.empty() && !merged.empty())
        throw UsageError("--tile makes a part, and --merge the whole: not both");
    if (options.curvature && !far_shadows.empty())
        throw UsageError(
            "-o: far shadows are of the scene's own ground, so --curvature is for the other results");
    if (refraction >= 0 && !options.curvature) throw UsageError("--refraction needs --curvature");
    if ((options.curvature || angular_diameter_deg >= 0) && hours.empty() && picture.empty() &&
        shadows.empty())
        throw UsageError("--curvature and --angular-diameter are for --hours, --picture and --shadows");
    if (refraction >= 0) options.refraction = refraction;
    if (angular_diameter_deg >= 0) options.angular_diameter_deg = angular_diameter_deg;
    for (const std::string& time : times) {
        const std::optional<double> hour = parse_time_of_day(time);
        if (!hour) throw UsageError(fmt::format("--shadow-time: '{}' is not a time, as 07:30 is", time));
        options.shadow_hours.push_back(*hour);
    }
    if (!part.empty()) read_part(part, options);
    options.merged.assign(merged.begin(), merged.end());
    options.shadows = shadows;
    options.run = run.value();
    options.run.exec = run.exec();
    options.far_shadows = far_shadows;
    options.hours = hours;
    options.picture = picture;
    options.list = list;
    return terrain_command(options);
}

}  // namespace obscura
