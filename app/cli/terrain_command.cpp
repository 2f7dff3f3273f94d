#include "app/cli/terrain_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/cli/messages.h"
#include "app/cli/scene_flags.h"
#include "app/cli/signals.h"
#include "app/cli/targets.h"
#include "app/cli/terrain_day.h"
#include "app/cli/terrain_shadows.h"
#include "app/cli/terrain_suns.h"
#include "app/frame/sun_hours_text.h"
#include "app/report/sun_hours_picture.h"
#include "app/scene/build.h"
#include "app/scene/terrain.h"
#include "app/scene/validate.h"
#include "core/count_text.h"
#include "core/error.h"
#include "core/image_io.h"
#include "hierarchy/terrain/day_light.h"
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

std::string far_text(const FarDay& day, const FarPlan& plan, const std::filesystem::path& path) {
    std::size_t suns = 0, units = 0;
    for (const int group : plan.groups) {
        suns += static_cast<std::size_t>(day.suns_of(group).count);
        units += static_cast<std::size_t>(day.tiles());
    }
    const double bits = static_cast<double>(day.bytes.size() + units * sizeof(FarUnit)) * 8;
    const double samples = static_cast<double>(day.grid.width) * day.grid.height * static_cast<double>(suns);
    return fmt::format("far shadows of {} suns in {} units: {} bytes, {:.5f} bits a sample and map: {}\n",
                       suns, units, day.bytes.size(), samples > 0 ? bits / samples : 0.0, path.string());
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

/// Lowers ground as the earth curves away, where that is asked for.
HeightField ground_of(HeightField field, const TerrainDayOptions& options, const std::string& scene) {
    if (!options.curvature) return field;
    const double east_m = 0.5 * (field.width() - 1) * field.cell_x_m,
                 north_m = 0.5 * (field.height() - 1) * field.cell_y_m;
    const double drop_m = earth_drop_m(east_m * east_m + north_m * north_m, options.refraction);
    if (metres_of(height_range(field).least_q16) - drop_m < -largest_height_m) {
        throw LimitError(
            fmt::format("{}: --curvature: the ground is so wide that its corners would lie {:.0f} m lower, "
                        "below {} m",
                        scene, drop_m, -largest_height_m));
    }
    return curved(field, options.refraction);
}

/// Refuses what would be refused when it is written, before anything is read or made.
void check_places(const TerrainDayOptions& options, const std::vector<ShadowPicture>& shadows,
                  FarFileState state, const ReadFiles& read) {
    // What is there already, or is to be completed, may exist; but no other result may go to it.
    std::vector<std::filesystem::path> all, fresh;
    const auto add = [&](const std::filesystem::path& path, bool is_fresh) {
        if (path.empty()) return;
        all.push_back(path);
        if (is_fresh) fresh.push_back(path);
    };
    for (const auto* path : {&options.hours, &options.picture, &options.list})
        add(*path, true);
    for (const ShadowPicture& picture : shadows)
        add(picture.file, true);
    // Before the hours are known the pattern stands for them.
    if (shadows.empty()) add(options.shadows, false);
    add(options.far_shadows, state == FarFileState::other);
    check_targets(all, {}, Existing::replace, read);
    check_targets(fresh, {}, options.run.existing(), read);
}

/// The shares of all the work that a run's three kinds of results take.
struct WorkShares {
    double far_end = 0, hours_end = 0;
};
WorkShares work_shares(bool far, bool hours, bool pictures) {
    const double of_far = far ? 4 : 0, of_hours = hours ? 1 : 0, of_pictures = pictures ? 0.5 : 0;
    const double all = std::max(of_far + of_hours + of_pictures, 0.5);
    return {of_far / all, (of_far + of_hours) / all};
}

void write_shadows(const HeightField& field, const std::vector<ShadowPicture>& pictures,
                   const TerrainDayOptions& options, const FarDayWatch& watch) {
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const Image<float> shares =
            lit_shares(field, pictures[i].sun, options.angular_diameter_deg / 2, options.run.exec);
        stop_if_requested();
        write_file_atomically(pictures[i].file, shadow_png(shares), options.run.existing());
        watch.progress(static_cast<int>(i + 1));
    }
}

}  // namespace

int terrain_command(const TerrainDayOptions& options) {
    const SceneRun& run = options.run;
    const bool wants_hours = !options.hours.empty() || !options.picture.empty();
    const bool wants_far = !options.far_shadows.empty();
    if (!wants_hours && !wants_far && options.list.empty() && options.shadows.empty())
        throw UsageError(
            "nothing to make: give -o, --hours, --picture, --shadows or --list (see 'obscura terrain "
            "--help')");
    const SceneDocument document = read_scene(run.scene, run.overrides);
    const FileAccess access = recording_access(run, document);
    const SceneTable& table = chosen_terrain(document, options.terrain);
    const Light sun = sun_of(document);
    // A folder that is not there or may not be written to is told before ground is read.
    check_places(options, {}, FarFileState::incomplete, *access.read);
    const Limits limits = limits_of(document);
    const std::string& named = text(table, "file");
    const HeightField field = ground_of(load_elevation(resolve_input(access, named), named, access, limits,
                                                       terrain_options_of(table, limits).elevation)
                                            .field,
                                        options, document.sources[0]);
    check_memory(field, limits, document.sources[0]);
    const std::vector<FarSun> suns =
        suns_of_day(field, *sun.path, static_cast<int>(options.suns), options.least_elevation_deg);
    if (suns.empty() && !run.quiet) say_note(no_sun_text(sun.id, *sun.path));
    std::vector<ShadowPicture> pictures;
    if (!options.shadows.empty()) {
        pictures = shadow_pictures(field, *sun.path, options.shadow_hours, options.least_elevation_deg,
                                   options.shadows);
    }
    const FarDayParams params{static_cast<int>(options.threshold), static_cast<int>(options.tile_side)};
    FarPlan plan;
    if (wants_far) {
        plan = plan_far_file(options, empty_far_day(field, suns, params),
                             {far_day_hash(field, suns, params), far_file_kind});
    }
    check_places(options, pictures, plan.state, *access.read);
    const auto tell = [&](const std::string& words) {
        if (!run.quiet) print(words);
    };
    if (plan.state == FarFileState::incomplete && !run.quiet)
        say_note(fmt::format("{} is incomplete or damaged, and what is missing is made",
                             options.far_shadows.string()));

    if (!options.list.empty())
        write_file_atomically(options.list, sun_list_text(*sun.path, suns), run.existing());
    set_signal_policy(OnSignal::ask_to_stop);
    Progress progress(stderr, Progress::style_for(stderr, run.quiet));
    const bool makes_far = wants_far && plan.state != FarFileState::made;
    const WorkShares shares = work_shares(makes_far, wants_hours, !pictures.empty());
    if (makes_far) {
        std::size_t count = 0;
        for (const int group : plan.groups)
            count += static_cast<std::size_t>(plan.known.suns_of(group).count);
        const FarDay day =
            make_far_file(options, field, plan, watch_of(progress, "far shadows", count, 0, shares.far_end));
        progress.clear();
        tell(far_text(day, plan, options.far_shadows));
    } else if (wants_far) {
        tell(fmt::format("far shadows of {} suns are there already: {}\n", suns.size(),
                         options.far_shadows.string()));
    }
    if (wants_hours) {
        const Image<float> hours =
            lit_hours(field, suns, options.angular_diameter_deg / 2, run.exec,
                      watch_of(progress, "hours of sun", suns.size(), shares.far_end, shares.hours_end));
        stop_if_requested();
        write_hours(hours, sun, options);
        progress.clear();
        const auto [least, most] = std::minmax_element(hours.pixels.begin(), hours.pixels.end());
        tell(fmt::format("hours of sun: {:.2f} to {:.2f} h, of suns of {:g} degrees and higher\n", *least,
                         *most, options.least_elevation_deg));
    }
    if (!pictures.empty()) {
        write_shadows(field, pictures, options,
                      watch_of(progress, "shadows", pictures.size(), shares.hours_end, 1));
        progress.clear();
        tell(fmt::format("shadows: {} to {}\n", count_text(pictures.size(), "picture"),
                         pictures.front().file.string()));
    }
    if (wants_hours || makes_far || !pictures.empty()) progress.finish();
    return 0;
}

}  // namespace obscura
