#include "app/cli/render_command.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/cli/flags.h"
#include "app/cli/messages.h"
#include "app/cli/render_plan.h"
#include "app/cli/scene_flags.h"
#include "app/cli/signals.h"
#include "app/cli/targets.h"
#include "app/frame/frame_checks.h"
#include "app/frame/load_scene.h"
#include "app/report/pixel_trace.h"
#include "app/report/render_stats.h"
#include "app/report/render_text.h"
#include "app/scene/build.h"
#include "core/stopwatch.h"

namespace obscura {
namespace {

/// Refuses what would be refused in any frame, before the first one is there.
void check_frames(const RenderPlan& plan, Scene& scene) {
    FrameChecks checks(plan.document, plan.frame_options);
    const std::vector<int> first{plan.frames.front()};
    for (const int frame : checks.worth_checking(plan.pixel ? first : plan.frames)) {
        set_frame(scene, plan.document, frame);
        checks.check(scene, frame);
    }
}

/// Prints what made one pixel of the first frame.
void explain_pixel(const RenderPlan& plan, Scene& scene, const FileAccess& access, const Exec& exec) {
    const int frame = plan.frames.front();
    set_frame(scene, plan.document, frame);
    const PixelTrace trace = in_stage(fmt::format("tracing a pixel of frame {}", frame), [&] {
        FrameCache cache;
        cache.access = access;
        return trace_pixel(scene, plan.pixel->x, plan.pixel->y, exec, cache);
    });
    print(trace.text);
}

RenderReport begin_report(const RenderPlan& plan, const Scene& scene, const SceneRun& run) {
    RenderReport report;
    const Region& crop = plan.frame_options.crop;
    report.run = {run.scene.string(),
                  run.exec,
                  crop.empty() ? plan.render.width : crop.width,
                  crop.empty() ? plan.render.height : crop.height,
                  plan.render.samples,
                  scene.limits.memory_mib};
    report.memory = estimate_memory(scene, {.lights = {}, .bright_px = {}, .channels = plan.frame_options});
    return report;
}

/// Encodes and writes the files of one frame.
void write_frame(const RenderPlan& plan, const Frame& frame, const SceneRun& run, FrameReport& report) {
    const Stopwatch watch;
    for (const PlannedOutput& output : plan.outputs) {
        stop_if_requested();
        const std::filesystem::path file = output_path(output, report.frame);
        const PictureFile picture = encode_picture(frame, output.aov, output.kind, plan.render, run.exec);
        write_file_atomically(file, picture.bytes, run.existing());
        report.files.push_back(
            {file.string(), output.aov, static_cast<std::int64_t>(picture.bytes.size()), picture.depth});
    }
    report.write_s = watch.seconds();
}

/// Of many frames only those with something to state are told one by one.
bool worth_telling(const FrameReport& report, const RenderPlan& plan, const SceneRun& run) {
    if (run.quiet) return false;
    return run.verbosity > 0 || plan.frames.size() == 1 ||
           std::any_of(report.files.begin(), report.files.end(),
                       [](const WrittenFile& file) { return file.depth.has_value(); });
}

/// All frames, one after the other; each uses all threads.
void render_frames(const RenderPlan& plan, Scene& scene, const FileAccess& access, const SceneRun& run,
                   RenderReport& report) {
    Progress progress(stderr, Progress::style_for(stderr, run.quiet));
    FrameOptions options = plan.frame_options;
    options.cancel = &stop_requested();
    options.progress = [&](double fraction) { progress.update(fraction); };
    FrameCache cache;
    cache.access = access;
    Frame frame;
    const auto say_notes = [&](const std::vector<std::string>& notes) {
        if (run.quiet || notes.empty()) return;
        progress.clear();
        std::for_each(notes.begin(), notes.end(), say_note);
    };
    for_each_frame(plan.frames, progress, [&](int number) {
        FrameReport& told = report.frames.emplace_back();
        told.frame = number;
        set_frame(scene, plan.document, number);
        if (number == plan.frames.front()) say_notes(scene_notes(scene, number));
        in_stage(fmt::format("rendering frame {}", number),
                 [&] { render_frame(scene, options, run.exec, cache, frame); });
        stop_if_requested();
        told.stats = frame.stats;
        say_notes(frame.stats.notices);
        in_stage(fmt::format("writing frame {}", number), [&] { write_frame(plan, frame, run, told); });
        if (number == plan.frames.back()) {
            progress.finish();
        } else {
            progress.clear();
        }
        if (worth_telling(told, plan, run)) say(frame_text(told, run.verbosity));
    });
}

FileKind kind_value(const std::string& flag, const std::string& text) {
    if (text == "png") return FileKind::png;
    if (text == "pfm") return FileKind::pfm;
    throw UsageError(flag + ": '" + text + "' is not png or pfm");
}

}  // namespace

int render_command(const RenderOptions& options) {
    const Stopwatch watch;
    const SceneRun& run = options.run;
    if (!options.pixel.empty() && is_standard_output(run.stats_json))
        throw UsageError("--stats-json -: --pixel prints to standard output and has no statistics");
    const RenderPlan plan = in_stage("reading the scene", [&] { return plan_render(options); });
    // Whatever would refuse a file after hours refuses it now.
    const FileAccess access = recording_access(run, plan.document);
    const auto results = result_files(plan);
    if (!plan.pixel) check_targets(results, run.stats_json, run.existing(), *access.read);
    Scene scene = in_stage("loading the scene", [&] { return load_scene(plan.document, access); });
    check_frames(plan, scene);

    if (plan.pixel) {
        explain_pixel(plan, scene, access, run.exec);
        return 0;
    }
    check_not_read(results, run.stats_json, *access.read);

    RenderReport report = begin_report(plan, scene, run);
    report.run.load_s = watch.seconds();
    if (run.verbosity > 0 && !run.quiet) say(plan_text(report, plan.frames.size()));

    // From here on there are results to lose: a signal lets the current file finish.
    set_signal_policy(OnSignal::ask_to_stop);
    render_frames(plan, scene, access, run, report);
    report.run.total_s = watch.seconds();
    write_stats(run.stats_json, stats_json(report), run.existing());
    return 0;
}

int run_render(const Arguments& arguments) {
    Flags flags("render [options] SCENE", "Renders a scene file to pictures.");
    RunFlags run;
    RenderOptions options;
    std::string aovs, aov_kind = "pfm";

    run.scene.add_to(flags);
    flags.group("Pictures");
    flags.text("-o,--output", "FILE", options.output,
               "Where the picture goes: .png (8-bit sRGB, exposure and tone curve applied) or .pfm (linear "
               "float radiance); the last #### of the name stands for the frame number and pads it (a "
               "single # only where the scene has several frames).",
               "the scene's list, else SCENE.png in the current folder");
    run.add_frames_to(flags);
    flags.text("--crop", "X0,Y0,X1,Y1", options.crop,
               "Render only these pixels of the whole picture, row 0 on top; X1 and Y1 lie outside.",
               "everything");
    flags.text(
        "--aov", "NAMES", aovs,
        "Further pictures beside the first, NAME.depth.pfm and so on: depth (m), normal, albedo, object, "
        "shadow, sun_hours (hours of direct sun along the sun's path); separated by commas.",
        "none");
    flags.text("--aov-format", "KIND", aov_kind, "pfm (numbers as they are) or png (mapped to look at).",
               "pfm");
    flags.text("--pixel", "X,Y", options.pixel,
               "Print every number that made this pixel of the first frame, and write nothing.", "off");
    run.add_execution_to(flags, "Write times (s), counts and memory (bytes) as JSON.");
    if (!flags.parse(arguments)) return 0;

    options.run = run.value();
    if (!aovs.empty()) options.aovs = aov_values("--aov", aovs);
    options.aov_kind = kind_value("--aov-format", aov_kind);
    options.run.exec = run.exec();
    return render_command(options);
}

}  // namespace obscura
