#include "app/frame/exact_shadow.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/frame/shadow_text.h"
#include "app/frame/soft_light.h"
#include "core/count_text.h"
#include "core/stopwatch.h"
#include "raster/exact/casters.h"
#include "raster/setup_memory.h"
#include "raster/shadow_map.h"

namespace obscura {

bool make_exact_shadow(const ShadowWork& work, const TreeNeeds*, std::int64_t, LightShadow& shadow) {
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

void give_exact_shadow(const ShadowWork&, const LightShadow& shadow, const TileScene& tiles,
                       TileLight& light) {
    light.exact = exact_light(shadow.light.light, shadow.exact, *tiles.mesh, tiles.rays);
}

std::string exact_shadow_text(const LightShadowStats& s) {
    std::string out;
    if (s.samples > 1) out += fmt::format("{} points of it, ", s.samples);
    if (s.penumbra_px > 0) {
        const bool more = s.penumbra_px >= static_cast<float>(most_auto_samples);
        out += fmt::format("penumbrae to {}{:.3g} pixels, ", more ? "more than " : "",
                           std::min(s.penumbra_px, static_cast<float>(most_auto_samples)));
    }
    return out + fmt::format("exact, {} triangles, {}{}; order {:.3f} s, samples {:.3f} s (all threads)\n",
                             s.casters, size_text(static_cast<std::int64_t>(s.bytes)), s.kept ? ", kept" : "",
                             s.build.build_s, s.lookup_s);
}

ShadowBytes exact_shadow_bytes(const SceneLight& light, const MeshSize& mesh, const RenderSettings&) {
    // Triangles at the borders of six views are in several of them.
    const bool six = shadow_view_count(light.light.kind) > 1;
    ShadowBytes bytes;
    bytes.kept = casters_bytes(six ? mesh.triangles * 5 / 4 : mesh.triangles);
    bytes.setup = setup_bytes(mesh) + casters_sorting_bytes(mesh.triangles);
    return bytes;
}

std::string exact_plan_text(const SceneLight& light, const std::optional<FoundResolution>&,
                            const Scene& scene) {
    const int views = shadow_view_count(light.light.kind);
    std::string soft;
    if (is_soft(light)) {
        soft = light.shadow.samples == auto_samples
                   ? fmt::format("; as many points of the light as its penumbrae are wide, 1 to {}",
                                 most_auto_samples)
                   : fmt::format("; {} points of the light", light.shadow.samples);
    }
    return fmt::format(
        ", shadows of the picture's own samples, exact: {} to put in order{}, up to {} to look up{}",
        count_text(caster_count(scene.mesh), "triangle"), views > 1 ? fmt::format(" in {} views", views) : "",
        picture_samples_text(scene), soft);
}

}  // namespace obscura
