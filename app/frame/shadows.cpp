#include "app/frame/shadows.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/frame/memory.h"
#include "app/frame/needed_texels.h"
#include "app/frame/scene_light.h"
#include "app/frame/shadow_cache.h"
#include "app/frame/shadow_memory.h"
#include "app/frame/shadow_resolution.h"
#include "app/frame/shadow_text.h"
#include "app/frame/stack_shadow.h"
#include "core/file_output.h"
#include "core/stopwatch.h"
#include "filters/shadow_lookup.h"
#include "raster/light_samples.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

/// Everything the steps below share.
struct Work {
    const Scene& scene;
    std::int64_t most_bytes;  ///< for all shadows together
    const Exec& exec;
    FrameCache& cache;
    std::span<TileScene> pictures;
    FrameStats& stats;
    const std::atomic<bool>* cancel;
};

bool wants_auto(const SceneLight& light) {
    const ShadowMethod method = light.shadow.method;
    return (method == ShadowMethod::compressed || method == ShadowMethod::stack) &&
           light.shadow.resolution == auto_resolution;
}

Bounds casters_of(const Scene& scene, const Light& light) {
    return is_parallel(light.kind) ? caster_box(scene.mesh, light.direction) : Bounds{};
}

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
        stats.code = light.shadow.code;
    }
    return stats;
}

/// Reads the shadow from its file. False when there is none that serves; a notice says why. A file with the
/// right key that holds something else than trees of these views is damaged, too.
bool load(const Work& work, const std::filesystem::path& file, const TreeFileKey& key,
          const std::vector<LightView>& views, LightShadow& shadow) {
    std::string notice;
    shadow.trees = load_shadow_cache(file, key, notice);
    const auto serves = [](const ShadowTree& tree, const LightView& view) { return tree.view == view; };
    if (!shadow.trees.empty() &&
        !std::equal(shadow.trees.begin(), shadow.trees.end(), views.begin(), views.end(), serves)) {
        shadow.trees.clear();
        notice = fmt::format(
            "{} is damaged (it holds shadow trees of other views than its key says); it is made again",
            file.string());
    }
    if (!notice.empty()) work.stats.notices.push_back(notice);
    if (shadow.trees.empty()) return false;
    count_trees(shadow);
    shadow.stats.from_cache = true;
    return true;
}

bool build_trees(const Work& work, const std::vector<NeededNodes>* needed, std::int64_t most_bytes,
                 LightShadow& shadow) {
    const SceneLight& light = shadow.light;
    if (light.shadow.cache.empty() || light.shadow.scope != ShadowScope::full) {
        return build_light_trees(work.scene.mesh, needed, work.exec, most_bytes, shadow, work.cancel);
    }
    const auto folder = shadow_cache_folder(work.cache.access, light.shadow.cache);
    const auto file = shadow_cache_file(folder, light.light.id, light.shadow.method);
    if (!work.cache.geometry) work.cache.geometry = geometry_key(work.scene.mesh);
    const auto views = fitted_shadow_views(light, shadow.casters, light.shadow.resolution);
    const TreeFileKey key = shadow_key(*work.cache.geometry, light, views);
    if (load(work, file, key, views, shadow)) return true;
    check_shadow_cache(file);
    if (!build_light_trees(work.scene.mesh, needed, work.exec, most_bytes, shadow, work.cancel)) return false;
    save_shadow_cache(file, shadow.trees, key);
    return true;
}

bool build_map(const Work& work, LightShadow& shadow) {
    FrameCache& cache = work.cache;
    const Stopwatch watch;
    if (!build_shadow_map(work.scene.mesh, shadow.light, cache.bounds, work.exec, cache.light_scratch,
                          shadow.map, work.cancel)) {
        return false;
    }
    shadow.stats.bytes =
        static_cast<std::uint64_t>(dense_map_bytes(shadow.light.light.kind, shadow.light.shadow.resolution));
    shadow.stats.build.build_s = watch.seconds();
    return true;
}

bool build_exact(const Work& work, LightShadow& shadow) {
    const Stopwatch watch;
    shadow.exact =
        build_casters(work.scene.mesh, shadow.light.light, work.exec, work.cache.caster_scratch, work.cancel);
    if (shadow.exact.empty()) return false;
    for (const Casters& view : shadow.exact) {
        shadow.stats.casters += static_cast<std::int64_t>(view.count);
        shadow.stats.bytes += static_cast<std::uint64_t>(view.bytes());
    }
    shadow.stats.build.build_s = watch.seconds();
    return true;
}

/// Refuses resolutions that make the frame too large, before anything is built.
void check_found(const Work& work, const std::vector<std::optional<FoundResolution>>& found) {
    std::vector<SceneLight> lights = work.scene.lights;
    if (settle_resolutions(found, lights))
        check_memory(estimate_memory(work.scene, {.lights = lights, .bright_px = {}, .channels = {}}),
                     work.scene.limits, "the frame");
}

/// Whether a surface may ask for shadows that is in no map: then intervals must hold for any receiver.
bool has_other_receivers(const Scene& scene) {
    const auto& objects = scene.mesh.objects;
    return std::any_of(objects.begin(), objects.end(), [](const Object& o) { return !o.casts_shadow; });
}

/// Settles what each light's shadow shall be; those that an earlier frame made are marked kept.
void plan_shadows(const Work& work) {
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
        if (told && found[i] && found[i]->capped && !(shadow.stats.found && shadow.stats.found->capped)) {
            work.stats.notices.push_back(capped_text(light, *found[i]));
        }
        const LightShadowStats fresh = fresh_stats(light, found[i]);
        const bool every_picture =
            light.shadow.method != ShadowMethod::compressed || light.shadow.scope == ShadowScope::full;
        const bool kept = !shadow.empty() && same_shadow(shadow.light, light) &&
                          (every_picture || same_picture(shadow, work.scene.camera, work.scene.render, seen));
        if (kept) {
            shadow.stats.kept = true;
            shadow.stats.found = found[i];
            shadow.stats.lookup_s = 0;
        } else {
            shadow.trees.clear();
            shadow.exact.clear();
            shadow.stack.reset();
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

/// What the picture reads of those shadows that are built for it alone, in their order.
std::vector<std::optional<std::vector<NeededNodes>>> needed_of_frame(const Work& work) {
    std::vector<PcfLight> lights;
    for (const LightShadow& s : work.cache.shadows) {
        if (s.stats.kept || s.light.shadow.method != ShadowMethod::compressed ||
            s.light.shadow.scope != ShadowScope::frame) {
            continue;
        }
        const auto views = fitted_shadow_views(s.light, s.casters, s.light.shadow.resolution);
        lights.push_back(pcf_light(s.light, views, work.scene.camera.eye));
        if (s.light.shadow.filter == ShadowFilter::hierarchical) {
            filter_hierarchically(lights.back(), work.pictures[0].rays);
        }
    }
    if (lights.empty()) return {};
    return needed_texels(work.pictures, lights, work.exec);
}

/// Makes one shadow that is not kept. `next_needed`: the next entry of `needed` that belongs to a shadow.
bool build_shadow(const Work& work, const std::vector<std::optional<std::vector<NeededNodes>>>& needed,
                  std::size_t& next_needed, std::int64_t most_bytes, LightShadow& shadow) {
    if (shadow.light.shadow.method == ShadowMethod::map) return build_map(work, shadow);
    if (shadow.light.shadow.method == ShadowMethod::exact) return build_exact(work, shadow);
    if (shadow.light.shadow.method == ShadowMethod::stack)
        return make_light_stack(work.scene.mesh, work.exec, most_bytes, work.cache, work.stats.notices,
                                shadow, work.cancel);
    if (shadow.light.shadow.scope == ShadowScope::full) return build_trees(work, nullptr, most_bytes, shadow);
    const auto& of_light = needed[next_needed++];
    if (!of_light) {
        shadow.stats.scope = ShadowScope::full;
        work.stats.notices.push_back(
            fmt::format("light '{}': the picture reads so much of the shadow map that all of it is built",
                        shadow.light.light.id));
        return build_trees(work, nullptr, most_bytes, shadow);
    }
    for (const NeededNodes& view : *of_light)
        shadow.stats.needed += static_cast<std::int64_t>(view.all().size());
    return build_trees(work, &*of_light, most_bytes, shadow);
}

bool build_shadows(const Work& work) {
    const Stopwatch watch;
    const auto needed = needed_of_frame(work);
    work.stats.needed_s = watch.seconds();
    std::size_t next_needed = 0;
    std::int64_t bytes = 0;
    for (LightShadow& shadow : work.cache.shadows) {
        if (!shadow.stats.kept) {
            if (!build_shadow(work, needed, next_needed, work.most_bytes - bytes, shadow)) {
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

void give_to_tiles(const Work& work, TileScene& tiles) {
    std::size_t next = 0;
    for (TileLight& light : tiles.lights) {
        if (!casts_shadows(work.scene.lights[light.scene_light])) continue;
        light.shadow = next;
        const LightShadow& shadow = work.cache.shadows[next++];
        if (shadow.light.shadow.method == ShadowMethod::exact) {
            light.exact = exact_light(shadow.light.light, shadow.exact, *tiles.mesh, tiles.rays);
            continue;
        }
        if (shadow.light.shadow.method == ShadowMethod::stack) {
            light.stack = stack_light(shadow, work.scene.camera.eye);
            continue;
        }
        if (shadow.light.shadow.method == ShadowMethod::map) {
            light.pcf = pcf_light(shadow.light, shadow.map, work.scene.camera.eye);
            continue;
        }
        light.pcf = pcf_light(shadow.light, std::span(shadow.trees), work.scene.camera.eye);
        if (shadow.light.shadow.filter == ShadowFilter::hierarchical) {
            filter_hierarchically(*light.pcf, tiles.rays);
        }
    }
}

/// Finds how many points of each soft light the pictures ask, and takes those that are asked for more than
/// one out of the tiles' lights.
void settle_soft_lights(const Work& work) {
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

/// What surfaces send on. False when cancelled.
bool give_sent_light(const Scene& scene, const Exec& exec, FrameCache& cache, std::span<TileScene> pictures,
                     const std::atomic<bool>* cancel) {
    const bool kept = cache.sent && cache.sent->sky == scene.sky && cache.sent->lights == scene.lights &&
                      cache.sent->materials == scene.materials;
    if (!kept) {
        cache.sent = {surface_light(scene, *cache.sky, exec, cancel), scene.lights, scene.materials,
                      scene.sky};
        if (cache.sent->light.empty()) {
            cache.sent.reset();
            return false;
        }
    }
    for (TileScene& tiles : pictures)
        tiles.sent = &cache.sent->light;
    return true;
}

/// The sky that the pictures show and are lit by. False when cancelled.
bool give_sky(const Scene& scene, const Exec& exec, FrameCache& cache, std::span<TileScene> pictures,
              const std::atomic<bool>* cancel) {
    const Sky& sky = scene.sky;
    if (sky.kind == SkyKind::gradient && !sky.occlusion) return true;
    if (!cache.sky || cache.sky->sky != sky) cache.sky = frame_sky(sky, exec);
    const bool lights = !cache.sky->lights.empty() && !scene.mesh.triangles.empty();
    for (TileScene& tiles : pictures) {
        tiles.sky = cache.sky->shade;
        tiles.sky_model = cache.sky->model ? &*cache.sky->model : nullptr;
        if (!lights) continue;
        SoftLight& soft = tiles.soft.emplace_back();
        soft.is_sky = true;
        soft.points = cache.sky->lights;
        soft.solid_angle_sr = cache.sky->solid_angle_sr;
    }
    return !lights || sky.bounces == 0 || give_sent_light(scene, exec, cache, pictures, cancel);
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
        if (light.shadow.method == ShadowMethod::stack) {
            queries.push_back(stack_query(scene.mesh, light));
        } else {
            queries.push_back(tree_query(light, casters_of(scene, light.light)));
        }
    }
    std::vector<std::optional<FoundResolution>> found(scene.lights.size());
    if (queries.empty()) return found;
    const auto answers = find_resolutions(pictures, scene.camera.eye, queries, exec);
    for (std::size_t i = 0; i < queries.size(); ++i)
        found[static_cast<std::size_t>(queries[i].light - scene.lights.data())] = answers[i];
    return found;
}

bool prepare_shadows(const Scene& scene, std::int64_t other_bytes, const Exec& exec, FrameCache& cache,
                     std::span<TileScene> pictures, FrameStats& stats, const std::atomic<bool>* cancel) {
    const Stopwatch watch;
    for (TileScene& tiles : pictures)
        tiles.casters = &scene.mesh;
    if (!give_sky(scene, exec, cache, pictures, cancel)) return false;
    // A scene without geometry has nothing to cast or to receive.
    if (cache.bounds.empty()) return true;
    const Work work{scene, (scene.limits.memory_mib << 20) - other_bytes, exec, cache, pictures, stats,
                    cancel};
    plan_shadows(work);
    stats.resolution_s = watch.seconds();
    if (!build_shadows(work)) return false;
    for (TileScene& tiles : pictures)
        give_to_tiles(work, tiles);
    settle_soft_lights(work);
    stats.shadow_s = watch.seconds();
    return true;
}

void forget_picture_shadows(FrameCache& cache) {
    for (LightShadow& shadow : cache.shadows) {
        const ShadowSettings& s = shadow.light.shadow;
        if (s.method == ShadowMethod::compressed && s.scope == ShadowScope::frame) shadow.trees.clear();
    }
}

}  // namespace obscura
