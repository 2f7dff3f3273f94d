#include "app/frame/shadow_text.h"

#include <fmt/format.h>

#include "app/frame/shadow_method.h"
#include "app/scene/shadow_code.h"
#include "hierarchy/codes/codes.h"

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

std::string shadow_text(const LightShadowStats& s) {
    return fmt::format("  light {}: ", s.light) + row_of(s.method).text(s);
}

}  // namespace obscura
