#include "app/frame/shadow_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace obscura {

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
    if (shadow.receivers == Receivers::any) {
        ways += ", let open surfaces shade the scene alone (receivers = \"static\")";
    }
    return ways + ", or use a dense map (method = \"map\")";
}

std::string shadow_text(const LightShadowStats& s) {
    std::string out = fmt::format("  light {}: ", s.light);
    if (s.method == ShadowMethod::exact) {
        if (s.samples > 1) out += fmt::format("{} points of it, ", s.samples);
        if (s.penumbra_px > 0) {
            const bool more = s.penumbra_px >= static_cast<float>(most_auto_samples);
            out += fmt::format("penumbrae to {}{:.3g} pixels, ", more ? "more than " : "",
                               std::min(s.penumbra_px, static_cast<float>(most_auto_samples)));
        }
        return out +
               fmt::format("exact, {} triangles, {}{}; order {:.3f} s, samples {:.3f} s (all threads)\n",
                           s.casters, size_text(static_cast<std::int64_t>(s.bytes)), s.kept ? ", kept" : "",
                           s.build.build_s, s.lookup_s);
    }
    if (s.method == ShadowMethod::stack) {
        out += fmt::format("a stack of {} maps of {} x {}", s.samples, s.resolution, s.resolution);
        if (s.found) out += " (" + resolution_text(*s.found) + ")";
        out += fmt::format(", {}{}\n", size_text(static_cast<std::int64_t>(s.bytes)),
                           s.kept         ? ", kept"
                           : s.from_cache ? ", from the cache"
                                          : "");
        return out + fmt::format(
                         "    nodes_full {} nodes_empty {} nodes_leaf {}, anisotropy {}; build {:.3f} s, "
                         "lookups and shading {:.3f} s (all threads)\n",
                         s.nodes.full, s.nodes.empty, s.nodes.leaf, s.anisotropy, s.build.build_s,
                         s.lookup_s);
    }
    if (s.views > 1) out += fmt::format("{} maps of ", s.views);
    out += fmt::format("{} x {}", s.resolution, s.resolution);
    if (s.found) out += " (" + resolution_text(*s.found) + ")";
    const std::string bytes = size_text(static_cast<std::int64_t>(s.bytes));
    const char* origin = s.kept ? ", kept" : s.from_cache ? ", from the cache" : "";
    if (s.method == ShadowMethod::map) {
        return out + fmt::format(", {}{}; lookups {:.3f} s\n", bytes, origin, s.lookup_s);
    }
    out +=
        fmt::format(", {}, {}{}\n", s.scope == ShadowScope::frame ? "what the frame looks up" : "all of it",
                    bytes, origin);
    const BuildStats& b = s.build;
    out += fmt::format("    nodes_full {} nodes_empty {} nodes_leaf {}, needed {}, {}: {}\n", s.nodes.full,
                       s.nodes.empty, s.nodes.leaf, s.needed, name_of(s.code), s.code_text);
    out += fmt::format(
        "    nodes_visited {} certified_cover {} certified_mesh {} texels_rasterized {} list_operations {}\n",
        b.nodes_visited, b.certified_cover, b.certified_mesh, b.texels_rasterized, b.list_operations);
    out += fmt::format(
        "    setup {:.3f} s, build {:.3f} s, serialise {:.3f} s, lookups {:.3f} s (all threads)\n", b.setup_s,
        b.build_s, s.encode_s, s.lookup_s);
    return out;
}

}  // namespace obscura
