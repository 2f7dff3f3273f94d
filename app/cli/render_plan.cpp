#include "app/cli/render_plan.h"

#include <algorithm>

#include "app/frame/channels.h"
#include "app/scene/build.h"
#include "app/scene/keyframes.h"
#include "app/scene/light_kinds.h"
#include "core/error.h"

namespace obscura {
namespace {

bool has_sun(const SceneDocument& document) {
    const auto lights = subtables(document.root, "light");
    return std::any_of(lights.begin(), lights.end(),
                       [](const SceneTable* light) { return light_kind_of(*light).kind == LightKind::sun; });
}

}  // namespace

RenderPlan plan_render(const RenderOptions& options) {
    RenderPlan plan;
    plan.document = read_scene(options.run.scene, options.run.overrides);
    plan.render = render_settings_of(plan.document);
    plan.frames = frames_of(options.run, plan.document);
    const auto [width, height] = std::pair{plan.render.width, plan.render.height};
    if (!options.crop.empty()) plan.frame_options.crop = crop_value("--crop", options.crop, width, height);
    if (!options.pixel.empty()) plan.pixel = pixel_value("--pixel", options.pixel, width, height);
    plan.outputs =
        plan_outputs({options.output, options.aovs, options.aov_kind, options.run.scene.stem().string(),
                      plan.frames.size() > 1, scene_frames(plan.document).count() > 1},
                     outputs_of(plan.document));
    for (const PlannedOutput& output : plan.outputs)
        want_channel(output.aov, plan.frame_options);
    if (plan.frame_options.sun_hours && !has_sun(plan.document))
        throw UsageError("--aov sun_hours: the scene has no light of type \"sun\"");
    return plan;
}

std::vector<std::filesystem::path> result_files(const RenderPlan& plan) {
    std::vector<std::filesystem::path> files;
    for (const int frame : plan.frames) {
        for (const PlannedOutput& output : plan.outputs)
            files.push_back(output_path(output, frame));
    }
    return files;
}

}  // namespace obscura
