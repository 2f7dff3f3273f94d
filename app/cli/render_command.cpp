#include "app/cli/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <new>
#include <optional>

#include "app/cli/flag_values.h"
#include "app/cli/progress.h"
#include "app/cli/signals.h"
#include "app/frame/load_scene.h"
#include "app/frame/memory.h"
#include "app/frame/render_frame.h"
#include "app/frame/shadow_text.h"
#include "app/report/picture_file.h"
#include "app/report/pixel_trace.h"
#include "app/report/render_stats.h"
#include "app/scene/keyframes.h"
#include "core/edges.h"
#include "core/error.h"
#include "core/file_output.h"
#include "core/parallel.h"

namespace obscura {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Runs one stage; when memory ends in it, the message says in which.
template <class Fn>
auto in_stage(const std::string& stage, Fn&& fn) {
    try {
        return fn();
    } catch (const std::bad_alloc&) {
        throw LimitError("out of memory while " + stage);
    }
}

/// Everything that is settled before the scene is loaded.
struct RenderPlan {
    SceneDocument document;
    RenderSettings render;
    std::vector<int> frames;
    std::vector<PlannedOutput> outputs;
    FrameOptions frame_options;
    std::optional<PixelPlace> pixel;  ///< to be explained instead of rendering
    Existing existing = Existing::refuse;
};

std::vector<int> all_frames(const FrameRange& range) {
    std::vector<int> frames;
    for (int i = 0; i < range.count(); ++i)
        frames.push_back(range.at(i));
    return frames;
}

std::vector<Output> output_list(const SceneDocument& document) {
    std::vector<Output> outputs;
    for (const SceneTable* table : subtables(document.root, "output")) {
        const std::string& name = text(*table, "aov");
        const Aov aov = name == "beauty" ? Aov::beauty : aov_values("aov", name).front();
        outputs.push_back({aov, text(*table, "file")});
    }
    return outputs;
}

/// The channels that the files need.
void request_channels(const std::vector<PlannedOutput>& outputs, FrameOptions& options) {
    for (const PlannedOutput& output : outputs) {
        options.depth |= output.aov == Aov::depth;
        options.normal |= output.aov == Aov::normal;
        options.albedo |= output.aov == Aov::albedo;
        options.object |= output.aov == Aov::object;
        options.shadow |= output.aov == Aov::shadow;
    }
}

RenderPlan plan_render(const RenderOptions& options) {
    RenderPlan plan;
    plan.document = read_scene(options.scene, options.overrides);
    plan.render = render_settings_of(plan.document);
    const FrameRange range = scene_frames(plan.document);
    plan.frames =
        options.frames.empty() ? all_frames(range) : frame_values("--frames", options.frames, range);
    if (!options.crop.empty()) {
        const PixelRect r = crop_value("--crop", options.crop, plan.render.width, plan.render.height);
        plan.frame_options.crop = {r.x0, r.y0, r.width(), r.height()};
    }
    if (!options.pixel.empty()) {
        plan.pixel = pixel_value("--pixel", options.pixel, plan.render.width, plan.render.height);
    }
    plan.outputs = plan_outputs({options.output, options.aovs, options.aov_kind,
                                 options.scene.stem().string(), plan.frames.size() > 1},
                                output_list(plan.document));
    request_channels(plan.outputs, plan.frame_options);
    plan.existing = options.overwrite ? Existing::replace : Existing::refuse;
    return plan;
}

/// Whatever would refuse a file after hours refuses it now.
void check_outputs(const RenderPlan& plan, const RenderOptions& options) {
    for (const int frame : plan.frames) {
        for (const PlannedOutput& output : plan.outputs)
            check_writable(output_path(output, frame), plan.existing);
    }
    if (!options.stats_json.empty()) check_writable(options.stats_json, plan.existing);
}

/// Encodes and writes the files of one frame.
void write_frame(const RenderPlan& plan, const Frame& frame, const Exec& exec, FrameReport& report) {
    const Clock::time_point start = Clock::now();
    for (const PlannedOutput& output : plan.outputs) {
        stop_if_requested();
        const std::filesystem::path file = output_path(output, report.frame);
        const PictureFile picture = encode_picture(frame, output.aov, output.kind, plan.render, exec);
        write_file_atomically(file, picture.bytes, plan.existing);
        report.files.push_back(
            {file.string(), output.aov, static_cast<std::int64_t>(picture.bytes.size()), picture.depth});
    }
    report.write_s = seconds_since(start);
}

void say_plan(const RenderReport& report, std::size_t frames) {
    constexpr double mib = 1 << 20;
    const MemoryEstimate& m = report.memory;
    fmt::print(stderr, "{}: {} frame{}, {} x {} pixels, {} sample{} each, {} on {} threads\n", report.scene,
               frames, frames == 1 ? "" : "s", report.width, report.height, report.samples,
               report.samples == 1 ? "" : "s", isa_name(report.exec.isa),
               report.exec.threads > 0 ? report.exec.threads : hardware_threads());
    fmt::print(stderr,
               "loaded in {:.2f} s; memory about {:.0f} of {} MiB: meshes {:.0f}, textures {:.0f}, "
               "shadow maps {:.0f}, frame {:.0f}\n",
               report.load_s, static_cast<double>(m.total()) / mib, report.limit_mib,
               static_cast<double>(m.meshes) / mib, static_cast<double>(m.textures) / mib,
               static_cast<double>(m.shadow_maps) / mib, static_cast<double>(m.frame) / mib);
}

/// "frame 1 in 0.15 s: a.pfm, a.depth.png (0 = 7.08 m, 65534 = 8.88 m)".
void say_frame(const FrameReport& report, int verbosity) {
    std::string files;
    for (const WrittenFile& file : report.files) {
        files += (files.empty() ? "" : ", ") + file.file;
        if (!file.depth) continue;
        files += fmt::format(" (0 = {} m, {} = {} m)", file.depth->nearest_m, farthest_code,
                             file.depth->farthest_m);
    }
    fmt::print(stderr, "frame {} in {:.2f} s: {}\n", report.frame, report.stats.total_s + report.write_s,
               files);
    if (verbosity == 0) return;
    const FrameStats& s = report.stats;
    fmt::print(
        stderr,
        "  surfaces {:.3f} s, setup {:.3f} s, shadow maps {:.3f} s ({}), tiles {:.3f} s, files {:.3f} s\n",
        s.surface_s, s.setup_s, s.shadow_s, s.shadow_maps, s.tiles_s, report.write_s);
    fmt::print(stderr,
               "  {} triangles, {} in view, {} samples, {} of them on a surface; {} MiB at most so far\n",
               s.triangles, s.records, s.samples, s.covered_samples, peak_resident_bytes() >> 20);
    if (s.resolution_s + s.needed_s > 0.0005) {
        fmt::print(stderr, "  of shadow maps: resolutions {:.3f} s, finding what is looked up {:.3f} s\n",
                   s.resolution_s, s.needed_s);
    }
    for (const LightShadowStats& light : s.lights)
        fmt::print(stderr, "{}", shadow_text(light));
    if (!s.glare) return;
    fmt::print(stderr, "  glare {:.3f} s, of it patterns {:.3f} s: {}\n", s.glare->total_s, s.glare->psf_s,
               s.glare->reason);
    if (s.glare->sources == 0) return;
    fmt::print(stderr, "  {:.2f} % of their light left its pixel, {:.2f} % the picture; {} wavelengths\n",
               100 * s.glare->spread, 100 * s.glare->lost, s.glare->wavelengths);
}

/// Tells what is right to ask for but often a mistake: nothing to see, a sun that has set.
void say_notes(const Scene& scene, int frame) {
    const Mesh& mesh = scene.mesh;
    const bool solid = std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        return !is_degenerate(mesh.positions[t.v[0]], mesh.positions[t.v[1]], mesh.positions[t.v[2]]);
    });
    if (!solid)
        fmt::print(stderr, "obscura: note: no mesh has a triangle with an area; only the sky is seen\n");
    for (const auto& [light, shadow] : scene.lights) {
        if (!light.below_horizon) continue;
        fmt::print(stderr, "obscura: note: light '{}' is below the horizon in frame {} and sheds no light\n",
                   light.id, frame);
    }
}

/// All frames, one after the other; each uses all threads.
void render_frames(RenderPlan& plan, Scene& scene, const RenderOptions& options, RenderReport& report) {
    Progress progress(stderr, Progress::style_for(stderr, options.quiet));
    plan.frame_options.cancel = &stop_requested();
    plan.frame_options.progress = [&](double fraction) { progress.update(fraction); };
    FrameCache cache;
    cache.access = FileAccess{plan.document.folder, options.allowed_paths};
    Frame frame;
    const auto count = static_cast<double>(plan.frames.size());
    for (std::size_t i = 0; i < plan.frames.size(); ++i) {
        const int number = plan.frames[i];
        const auto done = static_cast<double>(i);
        progress.begin(fmt::format("frame {} ({} of {})", number, i + 1, plan.frames.size()), done / count,
                       (done + 1) / count);
        FrameReport& frame_report = report.frames.emplace_back();
        frame_report.frame = number;
        set_frame(scene, plan.document, number);
        if (i == 0 && !options.quiet) say_notes(scene, number);
        in_stage(fmt::format("rendering frame {}", number),
                 [&] { render_frame(scene, plan.frame_options, options.exec, cache, frame); });
        stop_if_requested();
        frame_report.stats = frame.stats;
        if (!options.quiet && !frame.stats.notices.empty()) {
            progress.clear();
            for (const std::string& notice : frame.stats.notices)
                fmt::print(stderr, "obscura: note: {}\n", notice);
        }
        in_stage(fmt::format("writing frame {}", number),
                 [&] { write_frame(plan, frame, options.exec, frame_report); });
        // Of many frames only those with something to state are told one by one.
        if (i + 1 == plan.frames.size()) {
            progress.finish();
        } else {
            progress.clear();
        }
        const bool states = std::any_of(frame_report.files.begin(), frame_report.files.end(),
                                        [](const WrittenFile& f) { return f.depth.has_value(); });
        if (!options.quiet && (states || options.verbosity > 0 || plan.frames.size() == 1)) {
            say_frame(frame_report, options.verbosity);
        }
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
    std::fwrite(trace.text.data(), 1, trace.text.size(), stdout);
}

}  // namespace

int render_command(const RenderOptions& options) {
    const Clock::time_point start = Clock::now();
    RenderPlan plan = in_stage("reading the scene", [&] { return plan_render(options); });
    if (!plan.pixel) check_outputs(plan, options);
    const FileAccess access{plan.document.folder, options.allowed_paths};
    Scene scene = in_stage("loading the scene", [&] { return load_scene(plan.document, access); });

    if (plan.pixel) {
        explain_pixel(plan, scene, access, options.exec);
        return 0;
    }

    RenderReport report;
    report.scene = options.scene.string();
    report.exec = options.exec;
    const Region& crop = plan.frame_options.crop;
    report.width = crop.width > 0 ? crop.width : plan.render.width;
    report.height = crop.height > 0 ? crop.height : plan.render.height;
    report.samples = plan.render.samples;
    report.memory = estimate_memory(scene);
    report.limit_mib = scene.limits.memory_mib;
    report.load_s = seconds_since(start);
    if (options.verbosity > 0 && !options.quiet) say_plan(report, plan.frames.size());

    // From here on there are results to lose: a signal lets the current file finish.
    set_signal_policy(OnSignal::ask_to_stop);
    render_frames(plan, scene, options, report);
    report.total_s = seconds_since(start);
    if (!options.stats_json.empty()) {
        write_file_atomically(options.stats_json, stats_json(report), plan.existing);
    }
    return 0;
}

}  // namespace obscura
