#include "app/frame/sky_light.h"

#include "app/frame/frame_sky.h"
#include "app/frame/surface_light.h"

namespace obscura {
namespace {

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

}  // namespace

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

}  // namespace obscura
