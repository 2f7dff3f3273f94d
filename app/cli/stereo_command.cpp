#include "app/cli/stereo_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <tuple>

#include "app/cli/messages.h"
#include "app/cli/signals.h"
#include "app/cli/targets.h"
#include "app/frame/frame_checks.h"
#include "app/frame/load_scene.h"
#include "app/pair/pair.h"
#include "app/report/output_plan.h"
#include "app/report/pair_notes.h"
#include "app/report/pair_page.h"
#include "app/report/pair_pictures.h"
#include "app/report/pair_stats.h"
#include "app/scene/build.h"
#include "app/scene/keyframes.h"
#include "app/scene/stereo_settings.h"
#include "core/stopwatch.h"

namespace obscura {
namespace {

/// Everything that is settled before the scene is loaded.
struct StereoPlan {
    SceneDocument document;
    std::vector<int> frames;
    std::vector<StereoFile> files;
    bool screen_given = false;  ///< zero_parallax_m is in the scene
};

bool gives_screen(const SceneTable& root) {
    if (root.has("stereo") && subtable(root, "stereo").has("zero_parallax_m")) return true;
    for (const SceneTable* keyframe : subtables(subtable(root, "frames"), "stereo")) {
        if (keyframe->has("zero_parallax_m")) return true;
    }
    return false;
}

StereoPlan plan_stereo(const StereoOptions& options) {
    StereoPlan plan;
    plan.document = read_scene(options.run.scene, options.run.overrides);
    const SceneTable& root = plan.document.root;
    if (text(subtable(root, "camera"), "projection") != "perspective") {
        throw InputError(plan.document.sources[0],
                         "stereo needs a camera with projection = \"perspective\": parallel views have no "
                         "disparity");
    }
    plan.frames = frames_of(options.run, plan.document);
    StereoFileRequest request;
    const bool several = plan.frames.size() > 1;
    request.output = options.output.empty()
                         ? options.run.scene.stem().string() + (several ? ".stereo.####.png" : ".stereo.png")
                         : options.output;
    request.maps = options.maps;
    request.report = options.report;
    request.layout = options.layout;
    request.compare = options.compare;
    request.several_frames = several;
    request.least_run = least_number_run(several || scene_frames(plan.document).count() > 1);
    // The scene's own name stays as it is.
    request.output_run = options.output.empty() && !several ? 0 : request.least_run;
    plan.files = plan_stereo_files(request);
    plan.screen_given = gives_screen(root);
    return plan;
}

/// The files of all frames.
std::vector<std::filesystem::path> result_files(const StereoPlan& plan) {
    std::vector<std::filesystem::path> files;
    for (const int frame : plan.frames) {
        for (const StereoFile& file : plan.files)
            files.push_back(stereo_path(plan.files, file.role, frame));
    }
    return files;
}

void shrink_for_preview(Scene& scene) {
    scene.render.width = (scene.render.width + preview_scale - 1) / preview_scale;
    scene.render.height = (scene.render.height + preview_scale - 1) / preview_scale;
    scene.render.samples = 1;
}

/// Sets the scene to a frame. A preview's shadows are coarse dense maps, which are made in no time.
void set_stereo_frame(Scene& scene, const StereoPlan& plan, const StereoOptions& options, int frame) {
    set_frame(scene, plan.document, frame);
    if (!options.preview) return;
    scene.render.samples = 1;
    for (auto& [light, shadow] : scene.lights) {
        if (shadow.method == ShadowMethod::none) continue;
        const int most = shadow_view_count(light.kind) > 1 ? 512 : 2048;
        const bool automatic = shadow.resolution == auto_resolution;
        shadow.method = ShadowMethod::map;
        shadow.resolution = automatic ? most : std::min(shadow.resolution, most);
        shadow.filter_px = std::min(shadow.filter_px, 3);
    }
}

/// One run of the command: what its frames share.
struct Run {
    const StereoOptions& options;
    const StereoPlan& plan;
    Scene& scene;
    FileAccess access;
    Progress progress;
    StereoCache cache, compare_cache;
};

StereoSettings settings_of(const Run& run, int frame) {
    StereoSettings s = stereo_settings(run.plan.document, run.scene, frame, run.access);
    s.middle_picture = run.options.compare.warp || !run.options.maps.empty() || !run.options.report.empty();
    if (run.options.preview) s.reproject.tolerance_px = std::max(s.reproject.tolerance_px, 0.25);
    return s;
}

StereoPair make_pair(Run& run, const StereoSettings& settings, StereoCache& cache, bool measure) {
    StereoPairOptions options;
    options.measure = measure && !run.options.preview;
    options.channels.cancel = &stop_requested();
    options.channels.progress = [&](double fraction) { run.progress.update(fraction); };
    cache.eyes.frame.access = run.access;
    StereoPair pair;
    render_stereo_pair(run.scene, settings, options, run.options.run.exec, cache, pair);
    stop_if_requested();
    return pair;
}

void write_files(const Run& run, const std::vector<RoledFile>& files, const std::string& prefix,
                 StereoFrameReport& report) {
    const Stopwatch watch;
    for (const RoledFile& file : files) {
        stop_if_requested();
        const std::filesystem::path path = stereo_path(run.plan.files, prefix + file.role, report.frame);
        write_file_atomically(path, file.bytes, run.options.run.existing());
        report.files.push_back(
            {path.string(), prefix + file.role, static_cast<std::int64_t>(file.bytes.size())});
    }
    report.write_s += watch.seconds();
}

/// Two pictures in the layout that was asked for.
void write_both(const Run& run, const char* role, const Image<Vec3f>& left, const Image<Vec3f>& right,
                StereoFrameReport& report) {
    const StereoOptions& options = run.options;
    const auto& [first, second] = options.swap_eyes ? std::tie(right, left) : std::tie(left, right);
    write_files(run, laid_out_files(role, first, second, options.layout), "", report);
}

void write_layout(const Run& run, const char* role, const StereoPair& pair, StereoFrameReport& report) {
    const RenderSettings& render = run.scene.render;
    const Image<Vec3f> left = display_light(pair.eyes.left.radiance.view(), render, run.options.run.exec),
                       right = display_light(pair.eyes.right.radiance.view(), render, run.options.run.exec);
    write_both(run, role, left, right, report);
}

/// What the rig alone gives.
StereoSettings unedited(StereoSettings settings) {
    settings.middle_picture = false;
    settings.edits.clear();
    settings.remap = {};
    settings.edit.comfort = {};
    settings.edit.window_weight = 0;
    return settings;
}

/// The comparisons that were asked for, one after the other.
void write_comparisons(Run& run, const StereoPair& pair, const StereoSettings& settings,
                       StereoFrameReport& report) {
    const StereoCompare& compare = run.options.compare;
    const Stopwatch watch;
    const double written_s = report.write_s;
    if (compare.warp) {
        const WarpedPair both = warped_pair(pair, run.scene.render, run.options.run.exec);
        report.warp_holes = both.holes;
        write_both(run, "warp", both.left, both.right, report);
    }
    StereoSettings other = settings;
    other.middle_picture = false;
    other.edits.clear();
    if (compare.remap) {
        other.remap = settings.compare_remap;
        write_layout(run, "remap", make_pair(run, other, run.compare_cache, false), report);
        run.compare_cache.last.reset();
    }
    if (compare.unedited) {
        write_layout(run, "unedited", make_pair(run, unedited(settings), run.compare_cache, false), report);
        run.compare_cache.last.reset();
    }
    report.compare_s = watch.seconds() - (report.write_s - written_s);
}

/// The page, with what the rig alone would have given beside the pair.
void write_report(Run& run, const StereoPair& pair, const StereoSettings& settings,
                  StereoFrameReport& report) {
    const Stopwatch watch;
    const double written_s = report.write_s;
    const Exec& exec = run.options.run.exec;
    const RenderSettings& render = run.scene.render;
    const StereoPair rig = make_pair(run, unedited(settings), run.compare_cache, false);
    run.compare_cache.last.reset();
    const std::string page =
        stereo_report({run.scene, settings, pair, report, run.options.run.scene.filename().string(),
                       display_light(rig.eyes.left.radiance.view(), render, exec),
                       display_light(rig.eyes.right.radiance.view(), render, exec)},
                      exec);
    write_files(run, {{"report", page}}, "", report);
    report.compare_s += watch.seconds() - (report.write_s - written_s);
}

/// "frame 1 in 2.10 s: pair.png, ...".
void say_frame(const StereoFrameReport& report) {
    std::string files;
    for (const StereoWritten& file : report.files)
        files += (files.empty() ? "" : ", ") + file.file;
    say(fmt::format("frame {} in {:.2f} s: {}\n", report.frame,
                    report.times.total_s + report.compare_s + report.write_s, files));
}

void render_one(Run& run, int number, StereoReport& report) {
    set_stereo_frame(run.scene, run.plan, run.options, number);
    const StereoSettings settings = settings_of(run, number);
    const StereoPair pair = in_stage(fmt::format("rendering frame {}", number),
                                     [&] { return make_pair(run, settings, run.cache, true); });
    StereoFrameReport& frame = report.frames.emplace_back(frame_report(number, pair, settings));
    const FrameStats& shared = pair.eyes.shared;
    if (number == run.plan.frames.front())
        frame.notes.insert(frame.notes.begin(), run.scene.notes.begin(), run.scene.notes.end());
    frame.notes.insert(frame.notes.end(), shared.notices.begin(), shared.notices.end());
    in_stage(fmt::format("writing frame {}", number), [&] {
        write_layout(run, "", pair, frame);
        if (!run.options.maps.empty()) {
            write_files(run, map_files(pair, settings, run.scene.render, run.options.run.exec), "map.",
                        frame);
        }
        write_comparisons(run, pair, settings, frame);
        if (!run.options.report.empty()) write_report(run, pair, settings, frame);
    });
    if (run.options.run.quiet) return;
    run.progress.clear();
    const bool several = run.plan.frames.size() > 1;
    if (report.frames.size() == 1 && !run.plan.screen_given) {
        say_note(
            fmt::format("the screen stands where the camera looks, at {:.4g} m (stereo.zero_parallax_m moves "
                        "it)",
                        settings.rig.zero_parallax_m));
    }
    for (const std::string& note : frame.notes)
        say_note(several ? fmt::format("frame {}: {}", number, note) : note);
    if (!several || run.options.run.verbosity > 0) say_frame(frame);
    if (run.options.run.verbosity > 0) say(stereo_details(pair, settings));
}

/// Refuses what would be refused in any frame, before the first one is there. What frames change of the
/// settings takes no memory.
void check_frames(Run& run, const StereoSettings& settings) {
    FrameChecks checks(run.plan.document, {});
    for (const int frame : checks.worth_checking(run.plan.frames)) {
        set_stereo_frame(run.scene, run.plan, run.options, frame);
        checks.check(run.scene, frame, stereo_bytes(run.scene, settings));
    }
}

StereoReport begin_report(const StereoOptions& options, const Scene& scene) {
    StereoReport report;
    report.run = {options.run.scene.string(), options.run.exec,     scene.render.width,
                  scene.render.height,        scene.render.samples, scene.limits.memory_mib};
    report.layout = layout_name(options.layout);
    report.swapped_eyes = options.swap_eyes;
    report.preview = options.preview;
    return report;
}

}  // namespace

int stereo_command(const StereoOptions& options) {
    const Stopwatch watch;
    const StereoPlan plan = in_stage("reading the scene", [&] { return plan_stereo(options); });
    // Whatever would refuse a file after hours refuses it now.
    const FileAccess access = recording_access(options.run, plan.document);
    const auto results = result_files(plan);
    check_targets(results, options.run.stats_json, options.run.existing(), *access.read);
    Scene scene = in_stage("loading the scene", [&] { return load_scene(plan.document, access); });
    if (options.preview) shrink_for_preview(scene);

    Run run{options, plan, scene, access, {stderr, Progress::style_for(stderr, options.run.quiet)}, {}, {}};
    // Names that the scene does not have, and what will not fit, are told before the first tile.
    set_stereo_frame(scene, plan, options, plan.frames.front());
    check_frames(run, settings_of(run, plan.frames.front()));
    check_not_read(results, options.run.stats_json, *access.read);

    StereoReport report = begin_report(options, scene);
    report.run.load_s = watch.seconds();

    // From here on there are results to lose: a signal lets the current file finish.
    set_signal_policy(OnSignal::ask_to_stop);
    for_each_frame(plan.frames, run.progress, [&](int frame) { render_one(run, frame, report); });
    run.progress.finish();
    report.run.total_s = watch.seconds();
    write_stats(options.run.stats_json, stereo_stats_json(report), options.run.existing());
    return 0;
}

}  // namespace obscura
