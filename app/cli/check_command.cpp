#include "app/cli/check_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "app/cli/flags.h"
#include "app/cli/messages.h"
#include "app/cli/scene_flags.h"
#include "app/cli/scene_run.h"
#include "app/frame/channels.h"
#include "app/frame/frame_checks.h"
#include "app/frame/load_scene.h"
#include "app/frame/memory.h"
#include "app/frame/render_frame.h"
#include "app/frame/scene_light.h"
#include "app/frame/shadow_memory.h"
#include "app/frame/shadow_method.h"
#include "app/frame/shadow_text.h"
#include "app/frame/shadows.h"
#include "app/frame/soft_light.h"
#include "app/frame/stack_shadow.h"
#include "app/frame/sun_hours.h"
#include "app/frame/sun_hours_text.h"
#include "app/frame/tree_shadow.h"
#include "app/glare/glare_margin.h"
#include "app/pair/pair.h"
#include "app/report/lens_text.h"
#include "app/scene/keyframes.h"
#include "app/scene/light_kinds.h"
#include "app/scene/rules_shadow.h"
#include "app/scene/shadow_code.h"
#include "app/scene/stereo_settings.h"
#include "core/count_text.h"
#include "core/error.h"
#include "core/mesh_memory.h"
#include "raster/light_samples.h"
#include "raster/view.h"

namespace obscura {
namespace {

std::string point_text(Vec3d p) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z);
}

std::string camera_text(const Camera& c) {
    const std::string lens = c.kind == CameraKind::perspective
                                 ? fmt::format("perspective, {:.4g} degrees high", c.vfov_deg)
                                 : fmt::format("orthographic, {:.4g} m high", c.height_m);
    return fmt::format("camera    {}, from {} m to {} m\n", lens, point_text(c.eye), point_text(c.look_at));
}

std::string picture_text(const SceneDocument& document, const Scene& scene) {
    const FrameRange range = scene_frames(document);
    const SceneTable& frames = subtable(document.root, "frames");
    const std::size_t keyframes = subtables(frames, "camera").size() + subtables(frames, "light").size() +
                                  subtables(frames, "optics").size() + subtables(frames, "stereo").size() +
                                  subtables(frames, "stereo_edit").size();
    std::string out = fmt::format("picture   {} x {} pixels, {} each, exposure {:+.4g} EV\n",
                                  scene.render.width, scene.render.height,
                                  count_text(scene.render.samples, "sample"), scene.render.exposure_ev);
    out += fmt::format("frames    {} ({})", range.count(), text(frames, "range"));
    if (keyframes > 0)
        out += fmt::format(", {}, {}", count_text(keyframes, "keyframe"), text(frames, "interpolation"));
    out += '\n';
    for (const SceneTable* output : subtables(document.root, "output")) {
        out += fmt::format("output    {} -> {}\n", text(*output, "aov"), text(*output, "file"));
    }
    return out;
}

/// Whether a stack of the light, which is kept for all frames, would take less time than `exact`.
bool stack_pays(const SceneDocument& document, const SceneLight& light, const Scene& scene) {
    const bool somewhere =
        is_soft(light) && !is_parallel(light.light.kind) && light.light.kind != LightKind::surface;
    if (!somewhere || scene_frames(document).count() < stack_break_even_frames) return false;
    for (const SceneTable* k : subtables(subtable(document.root, "frames"), "light"))
        if (text(*k, "id") == light.light.id) return false;
    SceneLight stacked = light;
    if (stacked.shadow.samples == auto_samples) stacked.shadow.samples = stack_samples;
    try {
        plan_stack(scene.mesh, stacked);
    } catch (const InputError&) {
        return false;
    }
    return true;
}

/// Why this method and this code. `reason`: for the method.
std::string method_text(const ShadowSettings& s, const std::string& reason) {
    std::string out = fmt::format("          {}: {}\n", name_of(shadow_method_words, s.method), reason);
    const CodeChoice choice = chosen_code(s);
    if (s.method != ShadowMethod::compressed || choice.reason == nullptr) return out;
    return out + fmt::format("          {}: auto, {}\n", name_of(choice.code), choice.reason);
}

/// `light`: its resolution as found. `reason`: for its method.
std::string light_text(const SceneLight& light, const std::optional<FoundResolution>& found,
                       const Scene& scene, const std::string& reason) {
    std::string out = fmt::format("light     {}: {}", light.light.id, light_kind_name(light.light.kind));
    if (light.light.below_horizon) out += ", below the horizon in the first frame";
    if (light.shadow.method == ShadowMethod::none) return out + ", no shadows\n";
    const ShadowMethodRow& row = row_of(light.shadow.method);
    out += row.plan(light, found, scene) + '\n' + method_text(light.shadow, reason);
    if (!row.maps_middle || light.shadow.resolution == auto_resolution) return out;
    if (has_size(light.light)) {
        out += fmt::format(
            "note      light '{}': maps see its middle alone, so its shadows are hard; "
            "method = \"exact\" has penumbrae\n",
            light.light.id);
    }
    if (found) out += fmt::format("          {}\n", resolution_text(*found));
    if (found && tells_cap(light, *found)) out += fmt::format("note      {}\n", capped_text(light, *found));
    if (const std::string note = open_casters_note(light, scene); !note.empty())
        out += fmt::format("note      {}\n", note);
    return out;
}

/// What the scene's own files need.
FrameOptions channels_of(const std::vector<Output>& outputs) {
    FrameOptions channels;
    for (const Output& output : outputs)
        want_channel(output.aov, channels);
    return channels;
}

/// Refuses what rendering would refuse in any frame; the scene is at its first afterwards, as before.
void check_frames(const SceneDocument& document, const FrameOptions& channels, Scene& scene) {
    const FrameRange range = scene_frames(document);
    std::vector<int> frames;
    frames.reserve(static_cast<std::size_t>(range.count()));
    for (int i = 0; i < range.count(); ++i)
        frames.push_back(range.at(i));
    FrameChecks checks(document, channels);
    for (const int frame : checks.worth_checking(frames)) {
        set_frame(scene, document, frame);
        checks.check(scene, frame);
    }
    set_frame(scene, document, range.first);
}

/// What hours of sun take, asked for or not.
std::string hours_text(const Scene& scene) {
    const Light* sun = sun_with_path(scene);
    if (sun == nullptr || scene.mesh.triangles.empty()) return "";
    const MeshSize mesh = size_of(scene.mesh);
    const auto suns = static_cast<int>(sun_steps(*sun->path).size());
    std::string out = fmt::format("sun hours {}\n", sun_path_text(sun->id, *sun->path));
    if (suns == 0) return out + fmt::format("note      {}\n", no_sun_text(sun->id, *sun->path));
    const std::int64_t samples =
        std::int64_t{scene.render.width} * scene.render.height * scene.render.samples;
    return out + fmt::format(
                     "          exact: {}, each with all that casts shadows in order, {} in a pass, {}; up "
                     "to {} to look up for each; {} at most\n",
                     count_text(suns, "sun"), suns_together(mesh, suns),
                     count_text(sun_passes(mesh, suns), "pass", "passes"), count_text(samples, "sample"),
                     size_text(sun_hours_pass_bytes(mesh, suns) + sun_hours_tiles_bytes(mesh, suns) +
                               sun_hours_sums_bytes(scene.render)));
}

/// Finds what "auto" means for the first frame and puts it in the lights' places; refuses what rendering
/// would refuse then.
std::vector<std::optional<FoundResolution>> find_resolutions(Scene& scene, const FrameOptions& channels,
                                                             const Exec& exec) {
    std::vector<std::optional<FoundResolution>> found(scene.lights.size());
    const bool any = std::any_of(scene.lights.begin(), scene.lights.end(), [](const SceneLight& light) {
        return casts_shadows(light) && wants_auto(light);
    });
    if (!any || scene.mesh.triangles.empty()) return found;
    FrameCache cache;
    FrameStats stats;
    prepare_scene(scene, exec, cache, stats);
    const TileScene tiles = prepare_tiles(scene, exec, cache);
    found = auto_resolutions(scene, tiles, exec);
    settle_resolutions(found, scene.lights);
    check_memory(estimate_memory(scene, {.lights = {}, .bright_px = {}, .channels = channels}), scene.limits,
                 "the frame");
    return found;
}

std::string mesh_text(const Scene& scene) {
    const Mesh& mesh = scene.mesh;
    const auto closed = std::count_if(mesh.components.begin(), mesh.components.end(),
                                      [](const Component& c) { return c.closed; });
    const auto open = static_cast<std::int64_t>(mesh.components.size()) - closed;
    std::string out = fmt::format(
        "meshes    {}, {}, {}, {} closed and {} open {}\n", count_text(mesh.triangles.size(), "triangle"),
        count_text(mesh.positions.size(), "vertex", "vertices"), count_text(mesh.objects.size(), "object"),
        closed, open, open == 1 ? "component" : "components");
    for (const std::string& note : scene.notes)
        out += fmt::format("note      {}\n", note);
    if (mesh.triangles.empty()) out += "note      there is nothing to see but the sky\n";
    out += fmt::format("materials {}\n", scene.materials.size());
    for (const Texture& t : scene.textures) {
        out += fmt::format("texture   {}: {} x {} pixels, {}\n", t.name, t.levels[0].width,
                           t.levels[0].height, count_text(t.levels.size(), "level"));
    }
    return out;
}

/// `of`: nothing for the picture, or "a pair: ".
std::string memory_text(const char* of, const MemoryEstimate& e, const Scene& scene) {
    return fmt::format("memory    {}about {} of {} MiB: meshes {}, textures {}, shadow maps {}, frame {}\n",
                       of, size_text(e.total()), scene.limits.memory_mib, size_text(e.meshes),
                       size_text(e.textures), size_text(e.shadow_maps), size_text(e.frame));
}

}  // namespace

std::string check_report(const CheckOptions& options) {
    const SceneDocument document = read_scene(options.scene, options.overrides);
    SceneRun run;
    run.scene = options.scene;
    run.allowed_paths = options.allowed_paths;
    run.allow_missing = options.allow_missing;
    const FileAccess access = recording_access(run, document);
    Scene scene = load_scene(document, access);
    const FrameOptions channels = channels_of(scene.outputs);
    check_frames(document, channels, scene);
    std::string out = fmt::format("scene     {}\n", options.scene.string());
    out += picture_text(document, scene) + camera_text(scene.camera);
    // Before resolutions are found, as rendering tells it.
    const MemoryEstimate memory =
                             estimate_memory(scene, {.lights = {}, .bright_px = {}, .channels = channels}),
                         of_views = estimate_memory(scene);
    const auto found = find_resolutions(scene, channels, Exec{});
    const auto lights = subtables(document.root, "light");
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        out += light_text(scene.lights[i], found[i], scene, shadow_method_reason(document.root, *lights[i]));
        if (stack_pays(document, scene.lights[i], scene)) {
            out += fmt::format(
                "note      light '{}': its points have casters of their own, put in order for every one of "
                "{} frames; method = \"stack\" makes a map of each once, for pictures that are nearly the "
                "same\n",
                scene.lights[i].light.id, scene_frames(document).count());
        }
    }
    out += hours_text(scene);
    out += lens_text(scene.optics, scene.render, glare_margin(scene));
    std::string needs = memory_text("", memory, scene);
    if (document.root.has("stereo")) {
        const StereoSettings settings =
            stereo_settings(document, scene, scene_frames(document).first, access);
        out += stereo_text(settings, scene);
        // A pair writes views, none of the files that a picture has.
        MemoryEstimate pair = of_views;
        pair.frame += stereo_bytes(scene, settings);
        needs += memory_text("a pair: ", pair, scene);
        if (pair.total() > scene.limits.memory_mib << 20)
            needs += "note      a pair is refused: it needs more than limits.memory_mib\n";
    }
    return out + mesh_text(scene) + needs + "ok\n";
}

int check_command(const CheckOptions& options) {
    print(check_report(options));
    return 0;
}

int run_check(const Arguments& arguments) {
    Flags flags("check [options] SCENE",
                "Reads, loads and validates a scene and prints what rendering would compute: lights, shadow "
                "maps, memory, frames. Renders and writes nothing.");
    SceneFlags scene;
    scene.add_to(flags);
    if (!flags.parse(arguments)) return 0;
    return check_command({scene.scene, scene.all_overrides(), scene.allowed_paths(), scene.allow_missing});
}

}  // namespace obscura
