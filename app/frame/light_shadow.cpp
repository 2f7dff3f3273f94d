#include "app/frame/light_shadow.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/frame/scene_light.h"
#include "app/frame/shadow_text.h"
#include "core/error.h"
#include "core/stopwatch.h"

namespace obscura {
namespace {

bool stopped(const std::atomic<bool>* cancel) {
    return cancel != nullptr && cancel->load(std::memory_order_relaxed);
}

std::uint64_t top_bytes(const ShadowTree& tree) {
    return tree.top ? tree.top->size() * sizeof(TopNode) : 0;
}

void add(const BuildStats& view, BuildStats& sum) {
    sum.nodes_visited += view.nodes_visited;
    sum.certified_cover += view.certified_cover;
    sum.certified_mesh += view.certified_mesh;
    sum.texels_rasterized += view.texels_rasterized;
    sum.list_operations += view.list_operations;
    sum.facets += view.facets;
    sum.setup_s += view.setup_s;
    sum.build_s += view.build_s;
}

/// Nodes that a tree may have for its construction to stay within `bytes`: held twice while threads' parts
/// are joined, and once serialised.
std::uint64_t most_nodes(std::int64_t bytes) {
    constexpr std::int64_t bytes_per_node = 2 * std::int64_t{sizeof(MultiresNode)} + 8;
    return static_cast<std::uint64_t>(std::max<std::int64_t>(bytes, 0) / bytes_per_node);
}

MultiresTree build_tree(const Mesh& mesh, const SceneLight& light, const LightView& view, BuildParams params,
                        std::int64_t left_bytes, const Exec& exec, LightShadowStats& stats,
                        const std::atomic<bool>* cancel) {
    params.max_nodes = most_nodes(left_bytes);
    BuildStats of_view;
    try {
        MultiresTree tree = build_shadow_tree(mesh, view, params, exec, &of_view, cancel);
        add(of_view, stats.build);
        return tree;
    } catch (const LimitError& error) {
        throw LimitError(fmt::format(
            "light '{}', {} x {} texels: {}, more than fit into the {} MiB that limits.memory_mib leaves; {}",
            light.light.id, view.width, view.height, error.what(), left_bytes >> 20,
            smaller_tree_text(light.shadow)));
    }
}

}  // namespace

bool same_shadow(const SceneLight& x, const SceneLight& y) {
    const Light &a = x.light, &b = y.light;
    const ShadowSettings &s = x.shadow, &t = y.shadow;
    const bool same_light = a.kind == b.kind && a.direction == b.direction && a.position == b.position &&
                            a.outer_cone_deg == b.outer_cone_deg && a.near_m == b.near_m &&
                            a.range_m == b.range_m;
    const bool same_map = s.method == t.method && s.resolution == t.resolution &&
                          s.receivers == t.receivers && s.filter_px == t.filter_px;
    const bool same_tree = s.scope == t.scope && s.filter == t.filter && s.layout == t.layout &&
                           s.top_levels == t.top_levels && s.normal_offset_texels == t.normal_offset_texels;
    return same_light && same_map && (s.method != ShadowMethod::compressed || same_tree);
}

bool same_picture(const LightShadow& shadow, const Camera& camera, const RenderSettings& render) {
    const Camera& c = shadow.camera;
    return c.kind == camera.kind && c.eye == camera.eye && c.look_at == camera.look_at && c.up == camera.up &&
           c.vfov_deg == camera.vfov_deg && c.height_m == camera.height_m && c.near_m == camera.near_m &&
           shadow.render.width == render.width && shadow.render.height == render.height &&
           shadow.render.samples == render.samples;
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
        encode.layout = light.shadow.layout;
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
    for (const ShadowTree& tree : shadow.trees) {
        shadow.stats.nodes.full += tree.counts.full;
        shadow.stats.nodes.empty += tree.counts.empty;
        shadow.stats.nodes.leaf += tree.counts.leaf;
        shadow.stats.bytes += tree.bytes + top_bytes(tree);
    }
}

}  // namespace obscura
