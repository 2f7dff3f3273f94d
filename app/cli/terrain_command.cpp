#include "app/cli/terrain_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "app/cli/flags.h"
#include "app/cli/messages.h"
#include "app/cli/scene_flags.h"
#include "app/cli/signals.h"
#include "app/cli/targets.h"
#include "app/cli/terrain_suns.h"
#include "app/frame/sun_hours_text.h"
#include "app/report/output_plan.h"
#include "app/report/sun_hours_picture.h"
#include "app/scene/build.h"
#include "app/scene/terrain.h"
#include "app/scene/validate.h"
#include "core/error.h"
#include "core/image_io.h"
#include "hierarchy/terrain/far_file.h"

namespace obscura {
namespace {

const SceneTable& chosen_terrain(const SceneDocument& document, const std::string& id) {
    std::vector<std::string> ids;
    for (const SceneTable* terrain : subtables(document.root, "terrain")) {
        if (id.empty() || text(*terrain, "id") == id) return *terrain;
        ids.push_back(text(*terrain, "id"));
    }
    if (id.empty()) throw InputError(document.sources[0], "has no [[terrain]]");
    throw UsageError(fmt::format("--terrain: the scene has no terrain '{}'{}", id, hint(id, ids)));
}

/// The first sun, and its way over the day.
Light sun_of(const SceneDocument& document) {
    for (const SceneTable* light : subtables(document.root, "light")) {
        SceneLight found = light_of(*light);
        if (found.light.path) return found.light;
    }
    throw InputError(document.sources[0],
                     "has no [[light]] of type \"sun\", whose way over the day is wanted");
}

/// Maps in the making of one group of suns, and the sums; bits and floats for each sample.
void check_memory(const HeightField& field, const Limits& limits, const std::string& scene) {
    const std::int64_t samples = std::int64_t{field.width()} * field.height();
    const std::int64_t bytes = samples * (4 + 4 + 16 * 5 / 8);
    if (bytes > limits.memory_mib << 20) {
        throw LimitError(
            fmt::format("{}: a day over {} x {} samples takes {} MiB, more than limits.memory_mib = {}",
                        scene, field.width(), field.height(), bytes >> 20, limits.memory_mib));
    }
}

/// What the file holds: these far shadows; these, but altered since; or anything else.
enum class FarFileState { other, damaged, made };

FarFileState state_of(const std::filesystem::path& path, const TreeFileKey& key) {
    std::error_code error;
    if (path.empty() || !std::filesystem::exists(path, error)) return FarFileState::other;
    try {
        const FarFile file = read_far_file(path);
        if (file.key != key) return FarFileState::other;
        return is_intact(file.day) ? FarFileState::made : FarFileState::damaged;
    } catch (const InputError&) {
        return FarFileState::other;
    }
}

std::string far_text(const FarDay& day, const std::filesystem::path& path) {
    const double bits = static_cast<double>(day.bytes.size() + day.units.size() * sizeof(FarUnit)) * 8;
    const double samples =
        static_cast<double>(day.grid.width) * day.grid.height * static_cast<double>(day.suns.size());
    return fmt::format("far shadows of {} suns in {} units: {} bytes, {:.5f} bits a sample and map: {}\n",
                       day.suns.size(), day.units.size(), day.bytes.size(),
                       samples > 0 ? bits / samples : 0.0, path.string());
}

/// What is done for every sun, as a share of all.
FarDayWatch watch_of(Progress& progress, const char* label, std::size_t suns, double from, double to) {
    progress.begin(label, from, to);
    const auto count = static_cast<double>(std::max<std::size_t>(suns, 1));
    return {[&progress, count](int done) { progress.update(done / count); }, &stop_requested()};
}

void write_hours(const Image<float>& hours, const Light& sun, const TerrainDayOptions& options) {
    const auto existing = options.run.existing();
    if (!options.hours.empty()) write_file_atomically(options.hours, encode_pfm(hours.view()), existing);
    if (options.picture.empty()) return;
    SunHoursStats stats;
    stats.light = sun.id;
    stats.path = *sun.path;
    stats.sunlit = sunlit_spans(*sun.path);
    write_file_atomically(options.picture, encode_png(sun_hours_picture(hours.view(), stats).view()),
                          existing);
}

}  // namespace

int terrain_command(const TerrainDayOptions& options) {
    const SceneRun& run = options.run;
    const bool wants_hours = !options.hours.empty() || !options.picture.empty();
    if (!wants_hours && options.far_shadows.empty() && options.list.empty())
        throw UsageError(
            "nothing to make: give -o, --hours, --picture or --list (see 'obscura terrain --help')");
    const SceneDocument document = read_scene(run.scene, run.overrides);
    const FileAccess access = recording_access(run, document);
    const SceneTable& table = chosen_terrain(document, options.terrain);
    const Light sun = sun_of(document);
    const Limits limits = limits_of(document);
    const std::string& named = text(table, "file");
    const HeightField field = load_elevation(resolve_input(access, named), named, access, limits,
                                             terrain_options_of(table, limits).elevation)
                                  .field;
    check_memory(field, limits, document.sources[0]);
    const std::vector<FarSun> suns =
        suns_of_day(field, *sun.path, static_cast<int>(options.suns), options.least_elevation_deg);
    if (suns.empty() && !run.quiet) say_note(no_sun_text(sun.id, *sun.path));
    const FarDayParams params{static_cast<int>(options.threshold), static_cast<int>(options.tile_side)};
    const TreeFileKey key{far_day_hash(field, suns, params), far_file_kind};

    const FarFileState state = state_of(options.far_shadows, key);
    const bool made = state == FarFileState::made;
    // What is there already, or is to be repaired, may exist; but no other result may go to it.
    std::vector<std::filesystem::path> all, fresh;
    for (const auto* path : {&options.hours, &options.picture, &options.list, &options.far_shadows}) {
        if (path->empty()) continue;
        all.push_back(*path);
        if (path != &options.far_shadows || state == FarFileState::other) fresh.push_back(*path);
    }
    check_targets(all, {}, Existing::replace, *access.read);
    check_targets(fresh, {}, run.existing(), *access.read);
    const auto tell = [&](const std::string& words) {
        if (!run.quiet) print(words);
    };
    if (state == FarFileState::damaged && !run.quiet)
        say_note(fmt::format("{} is damaged and is made again", options.far_shadows.string()));

    if (!options.list.empty())
        write_file_atomically(options.list, sun_list_text(*sun.path, suns), run.existing());
    set_signal_policy(OnSignal::ask_to_stop);
    Progress progress(stderr, Progress::style_for(stderr, run.quiet));
    if (made) {
        tell(fmt::format("far shadows of {} suns are there already: {}\n", suns.size(),
                         options.far_shadows.string()));
    } else if (!options.far_shadows.empty()) {
        const FarDay day =
            make_far_day(field, suns, params, run.exec,
                         watch_of(progress, "far shadows", suns.size(), 0, wants_hours ? 0.8 : 1));
        stop_if_requested();
        write_far_file(options.far_shadows, day, key,
                       state == FarFileState::damaged ? Existing::replace : run.existing());
        progress.clear();
        tell(far_text(day, options.far_shadows));
    }
    if (wants_hours) {
        const double from = made || options.far_shadows.empty() ? 0 : 0.8;
        const Image<float> hours =
            lit_hours(field, suns, run.exec, watch_of(progress, "hours of sun", suns.size(), from, 1));
        stop_if_requested();
        write_hours(hours, sun, options);
        progress.clear();
        const auto [least, most] = std::minmax_element(hours.pixels.begin(), hours.pixels.end());
        tell(fmt::format("hours of sun: {:.2f} to {:.2f} h, of suns of {:g} degrees and higher\n", *least,
                         *most, options.least_elevation_deg));
    }
    if (wants_hours || !made) progress.finish();
    return 0;
}

int run_terrain(const Arguments& arguments) {
    Flags flags("terrain [options] SCENE",
                "The shadows of a day over a scene's [[terrain]], exact at every sample of its elevation "
                "model, along the "
                "way of the scene's sun.");
    RunFlags run;
    TerrainDayOptions options;
    std::string far_shadows, hours, picture, list;
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
    flags.whole("--tile", "SAMPLES", options.tile_side, 64, largest_far_tile_side,
                "Side of a tile, a multiple of 64.", "512");
    flags.group("Output");
    flags.text("-o,--output", "FILE", far_shadows, "Far shadows of all suns, tiles of which decode alone.",
               "none");
    flags.text(
        "--hours", "FILE", hours,
        "Hours of sun of every sample (.pfm), without those in which the sun stands below --least-elevation.",
        "none");
    flags.text("--picture", "FILE", picture, "The same in colours, with a scale (.png).", "none");
    flags.text("--list", "FILE", list, "When the suns stand where, and for how many hours (.csv).", "none");
    flags.on_off("--overwrite", run.run.overwrite, "Replace files that exist; otherwise they are an error.");
    flags.on_off("-q,--quiet", run.run.quiet, "Say nothing but errors.");
    add_exec_flags(flags, run.threads, run.isa);
    if (!flags.parse(arguments)) return 0;
    if (options.tile_side % 64 != 0) throw UsageError("--tile must be a multiple of 64");
    if (!hours.empty() && file_kind(hours) != FileKind::pfm)
        throw UsageError(fmt::format("--hours: '{}' does not end in .pfm", hours));
    if (!picture.empty() && file_kind(picture) != FileKind::png)
        throw UsageError(fmt::format("--picture: '{}' does not end in .png", picture));
    options.run = run.value();
    options.run.exec = run.exec();
    options.far_shadows = far_shadows;
    options.hours = hours;
    options.picture = picture;
    options.list = list;
    return terrain_command(options);
}

}  // namespace obscura
