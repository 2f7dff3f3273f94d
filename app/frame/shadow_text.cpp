#include "app/frame/shadow_text.h"

#include <fmt/format.h>

#include "app/frame/shadow_method.h"
#include "app/glare/glare_margin.h"
#include "app/scene/shadow_code.h"
#include "core/count_text.h"
#include "hierarchy/codes/codes.h"
#include "raster/shadow_map.h"

namespace obscura {
namespace {

/// Whether making the tree in its code takes more than by itself.
bool takes_more_memory(const ShadowSettings& shadow) {
    const auto node_bytes = [](ShadowCode code) { return row_of(code).node_construction_bytes; };
    return node_bytes(chosen_code(shadow).code) > node_bytes(ShadowCode::mh);
}

}  // namespace

std::string size_text(std::int64_t bytes) {
    const auto b = static_cast<double>(bytes);
    if (bytes < 10 << 10) return fmt::format("{} B", bytes);
    if (bytes < 10 << 20) return fmt::format("{:.1f} KiB", b / (1 << 10));
    return fmt::format("{:.1f} MiB", b / (1 << 20));
}

std::string resolution_text(const FoundResolution& found) {
    if (found.x < 0) return "auto: no pixel looks it up";
    return fmt::format("auto: {} texel spans {:.3g} pixels at most, at ({}, {})",
                       found.capped ? "capped, a" : "a", found.magnification, found.x, found.y);
}

bool tells_cap(const SceneLight& light, const FoundResolution& found) {
    return found.capped && (light.shadow.max_magnification != frame_magnification || found.magnification > 1);
}

std::string capped_text(const SceneLight& light, const FoundResolution& found) {
    return fmt::format(
        "light '{}': auto resolution ends at {} x {} texels, the most there are, and one still spans {:.3g} "
        "pixels at ({}, {}), above max_magnification {:.3g}",
        light.light.id, found.resolution, found.resolution, found.magnification, found.x, found.y,
        light.shadow.max_magnification);
}

std::string smaller_tree_text(const ShadowSettings& shadow) {
    std::string ways = "lower its resolution or raise max_magnification";
    if (shadow.scope == ShadowScope::full) ways += ", build only what the frame needs (scope = \"frame\")";
    if (takes_more_memory(shadow)) ways += ", write it by itself (code = \"mh\")";
    if (shadow.receivers == Receivers::any) {
        ways += ", let open surfaces shade the scene alone (receivers = \"static\")";
    }
    return ways + ", or use a dense map (method = \"map\")";
}

std::string maps_text(const LightShadowStats& s, const std::string& extent) {
    std::string out;
    if (s.views > 1) out += fmt::format("{} maps of ", s.views);
    out += fmt::format("{} x {}", s.resolution, s.resolution);
    if (s.found) out += " (" + resolution_text(*s.found) + ")";
    return out + fmt::format("{}, {}{}", extent, size_text(static_cast<std::int64_t>(s.bytes)),
                             s.kept         ? ", kept"
                             : s.from_cache ? ", from the cache"
                                            : "");
}

std::string maps_plan_text(const SceneLight& light, const char* kind, std::span<const LightView> views) {
    const ShadowSettings& s = light.shadow;
    const int maps = shadow_view_count(light.light.kind);
    std::string out = fmt::format(", {} {} shadow map{}", maps, kind, maps == 1 ? "" : "s");
    if (s.resolution == auto_resolution) return out + ", resolution auto";
    out += fmt::format(" of {} x {}", s.resolution, s.resolution);
    // How fine the parallel light's map is; it covers all of the scene.
    if (is_parallel(light.light.kind) && !views.empty())
        out += fmt::format(", texels of {:.3g} mm", 1000 * texel_size_m(views[0]));
    return out + fmt::format(", filter {} x {}", s.filter_px, s.filter_px);
}

std::size_t caster_count(const Mesh& mesh) {
    std::size_t casters = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        casters += mesh.objects.empty() || mesh.objects[mesh.object[t]].casts_shadow ? 1 : 0;
    return casters;
}

std::string picture_samples_text(const Scene& scene) {
    const std::int64_t margin = glare_margin(scene);
    return count_text(
        (scene.render.width + 2 * margin) * (scene.render.height + 2 * margin) * scene.render.samples,
        "sample");
}

std::string shadow_text(const LightShadowStats& s) {
    return fmt::format("  light {}: ", s.light) + row_of(s.method).text(s);
}

}  // namespace obscura
