#include "app/frame/tree_shadow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/frame/needed_texels.h"
#include "app/frame/scene_light.h"
#include "app/frame/shadow_cache.h"
#include "app/frame/shadow_text.h"
#include "app/scene/shadow_code.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "filters/shadow_lookup.h"
#include "hierarchy/build_memory.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "raster/lighting.h"
#include "raster/shadow_map.h"

namespace obscura {
namespace {

std::uint64_t top_bytes(const ShadowTree& tree) {
    return tree.top ? tree.top->size() * sizeof(TopNode) : 0;
}

/// Nodes of one view's tree, all of it. A model, not a bound: they grow with the length of the outlines on
/// the map, that is with its side; 31 to 32 per texel of the side in the closed city of Scandolo, Bauszat and
/// Eisemann 2016, more where there are many leaves. Construction stops at the limit. Nothing where the
/// picture decides the resolution: it is found later.
std::int64_t expected_nodes(const ShadowSettings& shadow) {
    constexpr std::int64_t nodes_per_side = 32;
    return std::min(nodes_per_side * shadow.resolution,
                    std::int64_t{shadow.resolution} * shadow.resolution * 4 / 3);
}

/// Nodes of all of a light's trees, as far as they are built; `squares`: that the picture reads of them.
std::int64_t built_nodes(const SceneLight& light, std::int64_t squares, const RenderSettings& render) {
    const ShadowSettings& s = light.shadow;
    const std::int64_t all = shadow_view_count(light.light.kind) * expected_nodes(s);
    // A light whose collection is given up has all of its map built. Else nodes follow the outlines that the
    // picture shows: 200 to 4000 per side of its samples were measured, most where there are leaves.
    if (!is_of_one_picture(s) || squares >= most_needed_squares) return all;
    const double side = std::sqrt(static_cast<double>(render.width) * render.height * render.samples);
    const std::int64_t seen = std::min(static_cast<std::int64_t>(250 * side), 2 * squares);
    return s.resolution == auto_resolution ? seen : std::min(all, seen);
}

std::int64_t expected_top_bytes(const SceneLight& light) {
    if (light.shadow.resolution == auto_resolution) return 0;
    return shadow_view_count(light.light.kind) * top_nodes_of(chosen_code(light.shadow).code) *
           (std::int64_t{sizeof(TopNode)} << (2 * light.shadow.top_levels));
}

/// Whether something casts shadows that is not the outside of a solid.
bool open_casters(const Mesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const bool casts = mesh.objects.empty() || mesh.objects[mesh.object[t]].casts_shadow;
        if (casts && !mesh.components[mesh.component[t]].closed) return true;
    }
    return false;
}

/// Nodes that a tree may have for its construction in this code to stay within `bytes`.
std::uint64_t most_nodes(std::int64_t bytes, const ShadowCodeRow& code) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(bytes, 0) / code.node_construction_bytes);
}

/// One tree, with its top grid. Without meaning when stopped.
ShadowTree build_tree(const Mesh& mesh, const SceneLight& light, const LightView& view, BuildParams params,
                      std::int64_t left_bytes, const Exec& exec, LightShadowStats& stats,
                      const std::atomic<bool>* cancel) {
    EncodeParams encode;
    encode.code = chosen_code(light.shadow).code;
    encode.layout = light.shadow.layout;
    encode.exec = exec;
    const ShadowCodeRow& code = row_of(encode.code);
    params.max_nodes = most_nodes(left_bytes, code);
    params.keep_intervals = code.wants_intervals;
    const bool from_mesh = is_from_mesh(code, params);
    BuildStats of_view;
    MultiresTree depths;
    ShadowTree tree;
    try {
        if (from_mesh) {
            tree = code.from_mesh(mesh, view, params, encode, &of_view, cancel);
        } else {
            depths = build_shadow_tree(mesh, view, params, exec, &of_view, cancel);
        }
        stats.build += of_view;
    } catch (const LimitError& error) {
        throw LimitError(fmt::format(
            "light '{}', {} x {} texels: {}, more than fit into the {} MiB that limits.memory_mib leaves; {}",
            light.light.id, view.width, view.height, error.what(), left_bytes >> 20,
            smaller_tree_text(light.shadow)));
    }
    if (stopped(cancel)) return {};
    const Stopwatch encoding;
    if (!from_mesh) tree = encode_tree(depths, view, encode);
    set_top_grid(tree, std::min(light.shadow.top_levels, tree.code.levels));
    stats.encode_s += encoding.seconds();
    return tree;
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

/// Reads the shadow from its file. False when there is none that serves; a notice says why. A file with the
/// right key that holds something else than trees of these views is damaged, too.
bool load(const ShadowWork& work, const std::filesystem::path& file, const TreeFileKey& key,
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

bool build_trees(const ShadowWork& work, const std::vector<NeededNodes>* needed, std::int64_t most_bytes,
                 LightShadow& shadow) {
    const SceneLight& light = shadow.light;
    if (light.shadow.cache.empty() || light.shadow.scope != ShadowScope::full) {
        return build_light_trees(work.scene.mesh, needed, work.exec, most_bytes, shadow, work.cancel);
    }
    const auto file =
        shadow_cache_file(work.cache.access, light.shadow.cache, light.light.id, light.shadow.method);
    if (!work.cache.geometry) work.cache.geometry = geometry_key(work.scene.mesh);
    const auto views = fitted_shadow_views(light, shadow.casters, light.shadow.resolution);
    const TreeFileKey key = shadow_key(*work.cache.geometry, light, views);
    if (load(work, file, key, views, shadow)) return true;
    check_shadow_cache(file);
    if (!build_light_trees(work.scene.mesh, needed, work.exec, most_bytes, shadow, work.cancel)) return false;
    save_shadow_cache(file, shadow.trees, key);
    return true;
}

}  // namespace

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
        ShadowTree tree =
            build_tree(mesh, light, views[i], params, most_bytes - kept_bytes, exec, shadow.stats, cancel);
        if (stopped(cancel)) {
            shadow.trees.clear();
            return false;
        }
        shadow.trees.push_back(std::move(tree));
        kept_bytes += static_cast<std::int64_t>(shadow.trees.back().bytes + top_bytes(shadow.trees.back()));
    }
    count_trees(shadow);
    return true;
}

ResolutionQuery tree_resolution(const Scene& scene, const SceneLight& light) {
    return tree_query(light, casters_of(scene, light.light));
}

std::vector<TreeNeeds> tree_needs(const ShadowWork& work) {
    std::vector<PcfLight> lights;
    for (const LightShadow& s : work.cache.shadows) {
        if (s.stats.kept || !is_of_one_picture(s.light.shadow)) continue;
        const auto views = fitted_shadow_views(s.light, s.casters, s.light.shadow.resolution);
        lights.push_back(pcf_light(s.light, views, work.scene.camera.eye));
        if (s.light.shadow.filter == ShadowFilter::hierarchical) {
            filter_hierarchically(lights.back(), work.pictures[0].rays);
        }
    }
    if (lights.empty()) return {};
    return needed_texels(work.pictures, lights, work.exec);
}

bool make_tree_shadow(const ShadowWork& work, const TreeNeeds* needs, std::int64_t most_bytes,
                      LightShadow& shadow) {
    if (needs == nullptr) return build_trees(work, nullptr, most_bytes, shadow);
    if (!*needs) {
        shadow.stats.scope = ShadowScope::full;
        work.stats.notices.push_back(
            fmt::format("light '{}': the picture reads so much of the shadow map that all of it is built",
                        shadow.light.light.id));
        return build_trees(work, nullptr, most_bytes, shadow);
    }
    for (const NeededNodes& view : **needs)
        shadow.stats.needed += static_cast<std::int64_t>(view.all().size());
    return build_trees(work, &**needs, most_bytes, shadow);
}

void give_tree_shadow(const ShadowWork& work, const LightShadow& shadow, const TileScene& tiles,
                      TileLight& light) {
    light.pcf = pcf_light(shadow.light, std::span(shadow.trees), work.scene.camera.eye);
    if (shadow.light.shadow.filter == ShadowFilter::hierarchical)
        filter_hierarchically(*light.pcf, tiles.rays);
}

std::int64_t expected_squares(const ShadowSettings& shadow, std::int64_t maps, const RenderSettings& render) {
    const std::int64_t pixels = std::int64_t{render.width} * render.height;
    // Of texels as large as pixels, neighbouring samples read the same squares; of small ones each its own.
    const std::int64_t fifths = shadow.max_magnification < 0.5 ? 8 * render.samples
                                : render.samples >= 16         ? 40
                                : render.samples >= 4          ? 15
                                                               : 6;
    const std::int64_t read = pixels * fifths / 5;
    const std::int64_t blocks = (std::int64_t{shadow.resolution} + 7) / 8;
    // Hierarchical kernels read coarser squares, too: a third more of them.
    const std::int64_t there =
        shadow.resolution == auto_resolution ? most_needed_squares : maps * blocks * blocks * 4 / 3 + 1;
    return std::min({read, there, most_needed_squares});
}

ShadowBytes tree_shadow_bytes(const SceneLight& light, const MeshSize& mesh, const RenderSettings& render) {
    // A word holds sixteen squares, of which a quarter are read; a code is one square. Codes of all lights
    // stay until their trees are made, and one light's words are there twice while they are sorted.
    constexpr std::int64_t word_bytes = sizeof(std::uint64_t) / 4, code_bytes = sizeof(std::uint64_t);
    const ShadowSettings& s = light.shadow;
    const std::int64_t maps = shadow_view_count(light.light.kind);
    const std::int64_t squares = is_of_one_picture(s) ? expected_squares(s, maps, render) : 0;
    const std::int64_t nodes = built_nodes(light, squares, render);
    ShadowBytes bytes;
    bytes.kept = nodes * node_bytes + expected_top_bytes(light);
    bytes.lists = squares * (word_bytes + code_bytes);
    // One view's tree at a time.
    bytes.making = std::max(
        construction_bytes(mesh) + nodes / maps * row_of(chosen_code(s).code).node_construction_bytes,
        squares * 2 * word_bytes);
    return bytes;
}

std::string tree_plan_text(const SceneLight& light, const std::optional<FoundResolution>&,
                           const Scene& scene) {
    const ShadowSettings& s = light.shadow;
    std::vector<LightView> views;
    if (s.resolution != auto_resolution && !scene.mesh.triangles.empty())
        views = fitted_shadow_views(light, caster_box(scene.mesh, light.light.direction), s.resolution);
    std::string out = maps_plan_text(light, "compressed", views);
    if (s.resolution == auto_resolution) return out;
    out += s.scope == ShadowScope::frame ? ", built for what the frame looks up" : ", built whole";
    const ShadowCode code = chosen_code(s).code;
    if (code != ShadowCode::mh) out += fmt::format(" as {}", name_of(code));
    if (!s.cache.empty()) out += fmt::format(" and kept in {}", s.cache);
    if (s.filter != ShadowFilter::pcf) out += ", filtered hierarchically";
    return out + fmt::format(", about {}", size_text(tree_shadow_bytes(light, {}, scene.render).kept));
}

std::string open_casters_note(const SceneLight& light, const Scene& scene) {
    const ShadowSettings& s = light.shadow;
    if (s.method != ShadowMethod::compressed || s.resolution == auto_resolution ||
        s.receivers != Receivers::any || !open_casters(scene.mesh)) {
        return "";
    }
    return fmt::format("light '{}': open surfaces under receivers = \"any\": the tree may need {} x {} nodes",
                       light.light.id, s.resolution, s.resolution);
}

std::string tree_shadow_text(const LightShadowStats& s) {
    std::string out =
        maps_text(s, s.scope == ShadowScope::frame ? ", what the frame looks up" : ", all of it") + '\n';
    const BuildStats& b = s.build;
    out += fmt::format("    nodes_full {} nodes_empty {} nodes_leaf {}, needed {}, {}: {}\n", s.nodes.full,
                       s.nodes.empty, s.nodes.leaf, s.needed, name_of(s.code), s.code_text);
    if (!s.code_reason.empty()) out += fmt::format("    {}: auto, {}\n", name_of(s.code), s.code_reason);
    out += fmt::format(
        "    nodes_visited {} certified_cover {} certified_mesh {} texels_rasterized {} list_operations {}\n",
        b.nodes_visited, b.certified_cover, b.certified_mesh, b.texels_rasterized, b.list_operations);
    return out +
           fmt::format(
               "    setup {:.3f} s, build {:.3f} s, serialise {:.3f} s, lookups {:.3f} s (all threads)\n",
               b.setup_s, b.build_s, s.encode_s, s.lookup_s);
}

}  // namespace obscura
