#include "app/frame/frame_checks.h"

#include <fmt/format.h>

#include <initializer_list>

#include "app/frame/day_shadow.h"
#include "app/frame/memory.h"
#include "app/frame/shadows.h"
#include "app/frame/stack_shadow.h"
#include "app/glare/lens.h"
#include "app/scene/build.h"
#include "app/scene/keyframes.h"
#include "app/scene/validate.h"
#include "core/error.h"

namespace obscura {
namespace {

bool has_keyframes(const SceneDocument& document, const char* of) {
    return !subtables(subtable(document.root, "frames"), of).empty();
}

bool same_place(const Place& a, const Place& b) {
    return a.source == b.source && a.line == b.line && a.column == b.column;
}

/// Where keyframes set one of the keys of `at`, which is `still` at a frame.
std::optional<Place> animated_place(const SceneTable& at, const SceneTable& still,
                                    std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
        const SceneEntry *now = at.find(key), *before = still.find(key);
        if (now == nullptr || now->value.place.source < 0) continue;
        if (before == nullptr || !same_place(now->value.place, before->value.place)) return now->value.place;
    }
    return std::nullopt;
}

/// Where the lens of a frame has last been described: the keyframe that sets how wide it opens, or [optics].
Place place_of_opening(const SceneDocument& document, double frame) {
    const SceneTable& optics = subtable(document.root, "optics");
    return animated_place(optics_at(document, frame), optics,
                          {"occluder_diameter", "occluder_x", "occluder_y", "obstruction", "aspect", "bow",
                           "rotation_deg", "f_number"})
        .value_or(document.root.find("optics")->place);
}

/// The same of how large its pattern is.
Place place_of_pattern(const SceneDocument& document, double frame) {
    const SceneTable &optics = subtable(document.root, "optics"), &camera = subtable(document.root, "camera");
    if (const auto place = animated_place(optics_at(document, frame), optics, {"f_number"})) return *place;
    return animated_place(camera_at(document, frame), camera, {"vfov_deg", "focal_length_mm"})
        .value_or(document.root.find("optics")->place);
}

/// "frame 3: " where frames differ.
std::string frame_text(const SceneDocument& document, int frame) {
    return scene_frames(document).count() > 1 ? fmt::format("frame {}: ", frame) : "";
}

/// The message of a fault at a place.
std::string told_at(const SceneDocument& document, const Place& place, const std::string& message) {
    try {
        fail_at(place, document.sources, message);
    } catch (const InputError& error) {
        return error.what();
    }
}

}  // namespace

FrameChecks::FrameChecks(const SceneDocument& document_, const FrameOptions& channels_)
    : document(document_), channels(channels_) {}

std::vector<int> FrameChecks::worth_checking(const std::vector<int>& frames) const {
    const bool lens_moves = document.root.has("optics") &&
                            (has_keyframes(document, "optics") || has_keyframes(document, "camera"));
    if (lens_moves || has_keyframes(document, "light")) return frames;
    return {frames.front()};
}

void FrameChecks::check_lens(const Scene& scene, int frame) const {
    if (!scene.optics.enabled) return;
    const std::string which = frame_text(document, frame);
    try {
        plan_far_field_psf(lens_aperture(scene.optics), psf_params(scene.optics, scene.render));
    } catch (const InputError& error) {
        fail_at(place_of_opening(document, frame), document.sources, which + error.message);
    } catch (const LimitError& error) {
        throw LimitError(told_at(document, place_of_pattern(document, frame), which + error.what()));
    }
}

void FrameChecks::check_days(const Scene& scene, int frame) const {
    const std::vector<const SceneTable*> lights = subtables(document.root, "light");
    obscura::check_days(scene, [&](std::size_t light, const std::string& why) {
        const SceneTable& table = *lights[light];
        const Place place =
            animated_place(light_at(document, table, frame), table, {"time", "azimuth_deg", "elevation_deg"})
                .value_or(place_of(subtable(table, "shadow"), "day_file"));
        fail_at(place, document.sources, frame_text(document, frame) + why);
    });
}

void FrameChecks::check_stacks(const Scene& scene, int frame) const {
    const std::vector<const SceneTable*> lights = subtables(document.root, "light");
    check_stack_plans(scene, [&](std::size_t light, const std::string& why) {
        const SceneTable& table = *lights[light];
        const Place place = animated_place(light_at(document, table, frame), table,
                                           {"position_m", "look_at_m", "azimuth_deg", "elevation_deg"})
                                .value_or(place_of(subtable(table, "shadow"), "method"));
        fail_at(place, document.sources, frame_text(document, frame) + why);
    });
}

void FrameChecks::check(const Scene& scene, int frame, std::int64_t further_bytes) {
    if (last_lights != scene.lights) {
        check_stacks(scene, frame);
        check_days(scene, frame);
    }
    last_lights = scene.lights;
    Needs now{optics_of(document, frame), std::nullopt, {}, further_bytes};
    if (now.optics.enabled) now.seen = scene.sky;
    for (const SceneLight& light : scene.lights)
        now.sheds.push_back(casts_shadows(light));
    if (last == now) return;
    if (!last || last->optics != now.optics) check_lens(scene, frame);
    MemoryEstimate memory = estimate_memory(scene, {.lights = {}, .bright_px = {}, .channels = channels});
    memory.frame += further_bytes;
    const std::string which = frame_text(document, frame).empty() ? "" : fmt::format(": frame {}", frame);
    check_memory(memory, scene.limits, document.sources[0] + which);
    last = std::move(now);
}

}  // namespace obscura
