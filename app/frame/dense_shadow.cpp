#include "app/frame/dense_shadow.h"

#include <fmt/format.h>

#include "app/frame/scene_light.h"
#include "app/frame/shadow_text.h"
#include "core/stopwatch.h"
#include "raster/setup_memory.h"
#include "raster/shadow_map.h"

namespace obscura {

bool make_dense_shadow(const ShadowWork& work, const TreeNeeds*, std::int64_t, LightShadow& shadow) {
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

void give_dense_shadow(const ShadowWork& work, const LightShadow& shadow, const TileScene&,
                       TileLight& light) {
    light.pcf = pcf_light(shadow.light, shadow.map, work.scene.camera.eye);
}

std::string dense_shadow_text(const LightShadowStats& s) {
    return maps_text(s) + fmt::format("; lookups {:.3f} s\n", s.lookup_s);
}

ShadowBytes dense_shadow_bytes(const SceneLight& light, const MeshSize& mesh, const RenderSettings&) {
    const int side = light.shadow.resolution;
    ShadowBytes bytes;
    bytes.kept = dense_map_bytes(light.light.kind, side);
    bytes.setup = setup_bytes(mesh) + bin_bytes(mesh.triangles, side, side, frame_tile_side);
    return bytes;
}

std::string dense_plan_text(const SceneLight& light, const std::optional<FoundResolution>&,
                            const Scene& scene) {
    std::vector<LightView> views;
    if (!scene.mesh.triangles.empty()) views = shadow_views(light, bounds_of(scene.mesh));
    return maps_plan_text(light, "dense", views) +
           fmt::format(", {}", size_text(dense_map_bytes(light.light.kind, light.shadow.resolution)));
}

}  // namespace obscura
