#include "app/frame/shadows.h"

#include <algorithm>

#include "app/frame/memory.h"
#include "app/frame/shadow_method.h"
#include "app/frame/shadow_text.h"
#include "app/frame/sky_light.h"
#include "app/frame/soft_light.h"
#include "app/frame/tree_shadow.h"
#include "app/scene/shadow_code.h"
#include "core/stopwatch.h"
#include "raster/light_samples.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

LightShadowStats fresh_stats(const SceneLight& light, const std::optional<FoundResolution>& found) {
    LightShadowStats stats;
    stats.light = light.light.id;
    stats.method = light.shadow.method;
    stats.resolution = light.shadow.resolution;
    stats.views = shadow_view_count(light.light.kind);
    stats.found = found;
    if (light.shadow.method == ShadowMethod::stack) stats.views = stats.samples = light.shadow.samples;
    if (light.shadow.method == ShadowMethod::compressed) {
        stats.scope = light.shadow.scope;
        const CodeChoice choice = chosen_code(light.shadow);
        stats.code = choice.code;
        if (choice.reason != nullptr) stats.code_reason = choice.reason;
    }
    return stats;
}

/// Refuses resolutions that make the frame too large, before anything is built.
void check_found(const ShadowWork& work, const std::vector<std::optional<FoundResolution>>& found) {
    std::vector<SceneLight> lights = work.scene.lights;
    if (settle_resolutions(found, lights))
        check_memory(
            estimate_memory(work.scene, {.lights = lights, .bright_px = {}, .channels = work.options}),
            work.scene.limits, "the frame");
}

/// Whether a surface may ask for shadows that is in no map: then intervals must hold for any receiver.
bool has_other_receivers(const Scene& scene) {
    const auto& objects = scene.mesh.objects;
    return std::any_of(objects.begin(), objects.end(), [](const Object& o) { return !o.casts_shadow; });
}

/// Settles what each light's shadow shall be; those that an earlier frame made are marked kept.
void plan_shadows(const ShadowWork& work) {
    const auto found = auto_resolutions(work.scene, work.pictures, work.exec);
    check_found(work, found);
    std::vector<LightShadow>& shadows = work.cache.shadows;
    const Region& seen = work.pictures[0].bins->region;
    std::size_t used = 0;
    for (std::size_t i = 0; i < work.scene.lights.size(); ++i) {
        SceneLight light = work.scene.lights[i];
        if (!casts_shadows(light)) continue;
        if (found[i]) light.shadow.resolution = found[i]->resolution;
        if (has_other_receivers(work.scene)) light.shadow.receivers = Receivers::any;
        if (used == shadows.size()) shadows.emplace_back();
        LightShadow& shadow = shadows[used++];
        // Of stacks the most is no more than a default.
        const bool told = light.shadow.method != ShadowMethod::stack;
        if (told && found[i] && tells_cap(light, *found[i]) &&
            !(shadow.stats.found && shadow.stats.found->capped)) {
            work.stats.notices.push_back(capped_text(light, *found[i]));
        }
        const LightShadowStats fresh = fresh_stats(light, found[i]);
        const bool kept = !shadow.empty() && same_shadow(shadow.light, light) &&
                          (!is_of_one_picture(light.shadow) ||
                           same_picture(shadow, work.scene.camera, work.scene.render, seen));
        if (kept) {
            shadow.stats.kept = true;
            shadow.stats.found = found[i];
            shadow.stats.lookup_s = 0;
        } else {
            shadow.trees.clear();
            shadow.exact.clear();
            shadow.stack.reset();
            shadow.day.reset();
            shadow.stats = fresh;
            if (light.shadow.method == ShadowMethod::map) {
                shadow.map.views.clear();  // not valid until it is built; its memory is used again
            } else {
                shadow.map = {};
                shadow.casters = casters_of(work.scene, light.light);
            }
        }
        shadow.light = light;
        shadow.camera = work.scene.camera;
        shadow.render = work.scene.render;
        shadow.seen = seen;
    }
    shadows.resize(used);
}

bool build_shadows(const ShadowWork& work) {
    const Stopwatch watch;
    const std::vector<TreeNeeds> needs = tree_needs(work);
    work.stats.needed_s = watch.seconds();
    std::size_t next = 0;
    std::int64_t bytes = 0;
    for (LightShadow& shadow : work.cache.shadows) {
        if (!shadow.stats.kept) {
            const TreeNeeds* of_tree = is_of_one_picture(shadow.light.shadow) ? &needs[next++] : nullptr;
            const ShadowMethodRow& row = row_of(shadow.light.shadow.method);
            if (!row.make(work, of_tree, work.most_bytes - bytes, shadow)) {
                shadow = {};
                return false;
            }
            work.stats.shadow_maps += shadow.stats.from_cache ? 0 : shadow.stats.views;
        }
        bytes += static_cast<std::int64_t>(shadow.stats.bytes);
    }
    work.stats.shadow_bytes += bytes;
    return true;
}

void give_to_tiles(const ShadowWork& work, TileScene& tiles) {
    std::size_t next = 0;
    for (TileLight& light : tiles.lights) {
        if (!casts_shadows(work.scene.lights[light.scene_light])) continue;
        light.shadow = next;
        const LightShadow& shadow = work.cache.shadows[next++];
        row_of(shadow.light.shadow.method).give(work, shadow, tiles, light);
    }
}

/// Finds how many points of each soft light the pictures ask, and takes those that are asked for more than
/// one out of the tiles' lights.
void settle_soft_lights(const ShadowWork& work) {
    for (std::size_t i = 0; i < work.cache.shadows.size(); ++i) {
        LightShadow& shadow = work.cache.shadows[i];
        if (!is_soft(shadow.light)) continue;
        if (shadow.light.shadow.samples == auto_samples)
            shadow.stats.penumbra_px = std::min(widest_penumbra(work.pictures, shadow, work.exec),
                                                static_cast<float>(most_auto_samples));
        shadow.stats.samples = points_for_penumbra(shadow.light, shadow.stats.penumbra_px);
        if (shadow.stats.samples == 1) continue;
        for (TileScene& tiles : work.pictures) {
            const auto at = std::find_if(tiles.lights.begin(), tiles.lights.end(),
                                         [&](const TileLight& l) { return l.exact && l.shadow == i; });
            SoftLight soft;
            soft.scene_light = at->scene_light;
            soft.shadow = i;
            soft.whole = shadow.light.light;
            soft.points = light_samples(soft.whole, shadow.stats.samples);
            if (is_parallel(soft.whole.kind)) soft.middle = at->exact;
            tiles.soft.push_back(std::move(soft));
            tiles.lights.erase(at);
        }
    }
}

}  // namespace

bool casts_shadows(const SceneLight& light) {
    return sheds_light(light.light) && light.shadow.method != ShadowMethod::none;
}

bool settle_resolutions(const std::vector<std::optional<FoundResolution>>& found,
                        std::vector<SceneLight>& lights) {
    bool any = false;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!found[i]) continue;
        lights[i].shadow.resolution = found[i]->resolution;
        any = true;
    }
    return any;
}

std::vector<std::optional<FoundResolution>> auto_resolutions(const Scene& scene,
                                                             std::span<const TileScene> pictures,
                                                             const Exec& exec) {
    std::vector<ResolutionQuery> queries;
    for (const SceneLight& light : scene.lights) {
        if (!casts_shadows(light) || !wants_auto(light)) continue;
        queries.push_back(row_of(light.shadow.method).query(scene, light));
    }
    std::vector<std::optional<FoundResolution>> found(scene.lights.size());
    if (queries.empty()) return found;
    const auto answers = find_resolutions(pictures, scene.camera.eye, queries, exec);
    for (std::size_t i = 0; i < queries.size(); ++i)
        found[static_cast<std::size_t>(queries[i].light - scene.lights.data())] = answers[i];
    return found;
}

bool prepare_shadows(const Scene& scene, std::int64_t other_bytes, const Exec& exec, FrameCache& cache,
                     std::span<TileScene> pictures, FrameStats& stats, const FrameOptions& options) {
    const Stopwatch watch;
    for (TileScene& tiles : pictures)
        tiles.casters = &scene.mesh;
    const bool has_sky = give_sky(scene, exec, cache, pictures, options.cancel);
    stats.sky_s = watch.seconds();
    if (!has_sky) return false;
    // A scene without geometry has nothing to cast or to receive.
    if (cache.bounds.empty()) return true;
    const ShadowWork work{
        scene,         (scene.limits.memory_mib << 20) - other_bytes, exec, cache, pictures, stats, options,
        options.cancel};
    plan_shadows(work);
    stats.resolution_s = watch.seconds() - stats.sky_s;
    if (!build_shadows(work)) return false;
    for (TileScene& tiles : pictures)
        give_to_tiles(work, tiles);
    settle_soft_lights(work);
    stats.shadow_s = watch.seconds();
    return true;
}

void forget_picture_shadows(FrameCache& cache) {
    for (LightShadow& shadow : cache.shadows)
        if (is_of_one_picture(shadow.light.shadow)) shadow.trees.clear();
}

}  // namespace obscura
