#include "app/frame/light_shadow.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/frame/scene_light.h"
#include "app/frame/shadow_text.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "hierarchy/codes/codes.h"

namespace obscura {
namespace {

bool stopped(const std::atomic<bool>* cancel) {
    return cancel != nullptr && cancel->load(std::memory_order_relaxed);
}

std::uint64_t top_bytes(const ShadowTree& tree) {
    return tree.top ? tree.top->size() * sizeof(TopNode) : 0;
}

/// Nodes that a tree may have for its construction in this code to stay within `bytes`.
std::uint64_t most_nodes(std::int64_t bytes, const ShadowCodeRow& code) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(bytes, 0) / code.node_construction_bytes);
}

MultiresTree build_tree(const Mesh& mesh, const SceneLight& light, const LightView& view, BuildParams params,
                        std::int64_t left_bytes, const Exec& exec, LightShadowStats& stats,
                        const std::atomic<bool>* cancel) {
    const ShadowCodeRow& code = row_of(light.shadow.code);
    params.max_nodes = most_nodes(left_bytes, code);
    params.keep_intervals = code.wants_intervals;
    BuildStats of_view;
    try {
        MultiresTree tree = build_shadow_tree(mesh, view, params, exec, &of_view, cancel);
        stats.build += of_view;
        return tree;
    } catch (const LimitError& error) {
        throw LimitError(fmt::format(
            "light '{}', {} x {} texels: {}, more than fit into the {} MiB that limits.memory_mib leaves; {}",
            light.light.id, view.width, view.height, error.what(), left_bytes >> 20,
            smaller_tree_text(light.shadow)));
    }
}

// What a shadow is made from: everything except what is named here as of no account, so that a setting which
// is added later counts until someone finds that it need not.

SceneLight shadow_part(SceneLight light) {
    static const SceneLight d;
    light.light.color = d.light.color;
    light.light.inner_cone_deg = d.light.inner_cone_deg;
    light.light.path = d.light.path;
    light.shadow.max_magnification = d.shadow.max_magnification;  // has settled the resolution
    return light;
}

RenderSettings geometry_part(RenderSettings render) {
    static const RenderSettings d;
    render.exposure_ev = d.exposure_ev;
    render.tone = d.tone;
    render.receivers = d.receivers;  // a default that lights have taken
    return render;
}

}  // namespace

bool same_shadow(const SceneLight& a, const SceneLight& b) {
    return shadow_part(a) == shadow_part(b);
}

bool same_picture(const LightShadow& shadow, const Camera& camera, const RenderSettings& render,
                  const Region& seen) {
    return shadow.camera == camera && geometry_part(shadow.render) == geometry_part(render) &&
           shadow.seen == seen;
}

bool build_light_trees(const Mesh& mesh, const std::vector<NeededNodes>* needed, const Exec& exec,
                       std::int64_t most_bytes, LightShadow& shadow, const std::atomic<bool>* cancel) {
    const SceneLight& light = shadow.light;
    const std::vector<LightView> views = fitted_shadow_views(light, shadow.casters, light.shadow.resolution);
    shadow.trees.clear();
    std::int64_t kept_bytes = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
        BuildParams params;
        params.receivers = light.shadow.receivers;
        params.needed = needed == nullptr ? nullptr : &(*needed)[i];
        const MultiresTree tree =
            build_tree(mesh, light, views[i], params, most_bytes - kept_bytes, exec, shadow.stats, cancel);
        if (stopped(cancel)) {
            shadow.trees.clear();
            return false;
        }
        const Stopwatch encoding;
        EncodeParams encode;
        encode.code = light.shadow.code;
        encode.layout = light.shadow.layout;
        encode.exec = exec;
        encode.top_levels = std::min(light.shadow.top_levels, tree.levels);
        shadow.trees.push_back(encode_tree(tree, views[i], encode));
        shadow.stats.encode_s += encoding.seconds();
        kept_bytes += static_cast<std::int64_t>(shadow.trees.back().bytes + top_bytes(shadow.trees.back()));
    }
    count_trees(shadow);
    return true;
}

void count_trees(LightShadow& shadow) {
    shadow.stats.nodes = {};
    shadow.stats.bytes = 0;
    shadow.stats.code_text =
        shadow.trees.empty() ? "" : row_of(shadow.trees[0].code.code).text(shadow.trees[0]);
    for (const ShadowTree& tree : shadow.trees) {
        shadow.stats.nodes.full += tree.counts.full;
        shadow.stats.nodes.empty += tree.counts.empty;
        shadow.stats.nodes.leaf += tree.counts.leaf;
        shadow.stats.bytes += tree.bytes + top_bytes(tree);
    }
}

}  // namespace obscura
