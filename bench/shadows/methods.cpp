#include "bench/shadows/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/frame/scene_light.h"
#include "bench/shadows/dense_points.h"
#include "core/stopwatch.h"
#include "filters/shadow_lookup.h"
#include "filters/tree_pcf.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/codes/query.h"
#include "raster/shadow_map.h"

namespace obscura {
namespace {

constexpr std::pair<const char*, int> kernels[] = {{"1 tap", 1}, {"3x3", 3}, {"5x5", 5}};

/// A tree as scenes keep it, with the default top grid, and the same without.
struct BuiltTree {
    std::vector<ShadowTree> usual, gridless;  ///< one each: pcf_light() wants a span
};

void look_up(const PcfLight& light, Isa isa, bool naive, const SurfaceBlock& surface, float* visible) {
    if (naive) {
        OBSCURA_DISPATCH(isa, naive_tree_pcf_block, surface, light, visible);
    } else {
        OBSCURA_DISPATCH(isa, pcf_block, surface, light, visible);
    }
}

std::vector<ShadowLookup> tree_lookups(const std::shared_ptr<const BuiltTree>& trees, const SceneLight& light,
                                       const Scene& scene, Isa isa) {
    const CameraRays rays = camera_rays(scene.camera, scene.render.width, scene.render.height);
    std::vector<ShadowLookup> lookups;
    enum class Way { shared, naive, hierarchical };
    const auto add = [&](const std::string& name, const std::vector<ShadowTree>& tree, int side, Way way) {
        PcfLight pcf = pcf_light(light, tree, scene.camera.eye);
        pcf.side = side;
        if (way == Way::hierarchical) filter_hierarchically(pcf, rays);
        lookups.push_back(
            {name, [trees, pcf, isa, naive = way == Way::naive](const SurfaceBlock& surface, float* visible) {
                 look_up(pcf, isa, naive, surface, visible);
             }});
    };
    for (const auto& [name, side] : kernels) {
        add(name, trees->usual, side, Way::shared);
        add(fmt::format("{}, no top grid", name), trees->gridless, side, Way::shared);
        if (side == 1) continue;
        add(fmt::format("{}, naive", name), trees->usual, side, Way::naive);
        add(fmt::format("{}, hierarchical", name), trees->usual, side, Way::hierarchical);
    }
    return lookups;
}

std::vector<PointLookup> tree_point_lookups(const std::shared_ptr<const BuiltTree>& trees, Isa isa) {
    std::vector<PointLookup> lookups;
    const auto add = [&](const std::string& name, const ShadowTree& tree, bool coherent) {
        lookups.push_back(
            {name, [trees, code = &tree.code, isa, coherent](const MapPoints& points, std::uint16_t* lit) {
                 if (coherent) {
                     OBSCURA_DISPATCH(isa, coherent_visibility, *code, points, 0, lit);
                 } else {
                     OBSCURA_DISPATCH(isa, visibility, *code, points, 0, lit);
                 }
             }});
    };
    add("points", trees->usual[0], false);
    add("points, coherent", trees->usual[0], true);
    add("points, no top grid", trees->gridless[0], false);
    add("points, no top grid, coherent", trees->gridless[0], true);
    return lookups;
}

}  // namespace

BuiltShadow build_dense(const Scene& scene, int size, const Exec& exec) {
    const SceneLight light = shadow_light(scene, size, 1);
    const Stopwatch watch;
    const auto map = std::make_shared<ShadowMap>();
    {
        RasterScratch scratch;
        build_shadow_map(scene.mesh, light, bounds_of(scene.mesh), exec, scratch, *map);
    }
    BuiltShadow built;
    built.build_s = watch.seconds();
    built.view = map->views[0];
    built.bytes = dense_map_bytes(light.light.kind, size);
    built.light = pcf_light(light, *map, scene.camera.eye);
    built.lookups = [map, pcf = built.light](Isa isa) {
        std::vector<ShadowLookup> lookups;
        for (const auto& [name, side] : kernels) {
            PcfLight with_side = pcf;
            with_side.side = side;
            lookups.push_back({name, [map, with_side, isa](const SurfaceBlock& surface, float* visibility) {
                                   OBSCURA_DISPATCH(isa, pcf_block, surface, with_side, visibility);
                               }});
        }
        return lookups;
    };
    built.point_lookups = [map](Isa isa) -> std::vector<PointLookup> {
        return {{"points", [map, isa](const MapPoints& points, std::uint16_t* lit) {
                     const StoredDepths& stored = map->stored[0];
                     OBSCURA_DISPATCH(isa, dense_visibility, stored.depth.data(), stored.size, points, lit);
                 }}};
    };
    return built;
}

BuiltShadow build_compressed(const Scene& scene, int size, const Exec& exec) {
    const SceneLight light = shadow_light(scene, size, 1);
    const Stopwatch watch;
    const LightView view = shadow_views(light, bounds_of(scene.mesh))[0];
    const auto trees = std::make_shared<BuiltTree>();
    ShadowTree tree = encode_tree(build_shadow_tree(scene.mesh, view, {}, exec), view);
    const int top_levels = std::min(tree.code.levels, ShadowSettings{}.top_levels);
    set_top_grid(tree, top_levels);
    BuiltShadow built;
    built.build_s = watch.seconds();
    built.view = view;
    built.bytes = static_cast<std::int64_t>(tree.bytes) +
                  (static_cast<std::int64_t>(sizeof(TopNode)) << (2 * top_levels));
    trees->gridless.push_back(tree);
    set_top_grid(trees->gridless[0], 0);
    trees->usual.push_back(std::move(tree));
    built.light = pcf_light(light, trees->usual, scene.camera.eye);
    const std::shared_ptr<const BuiltTree> kept = trees;
    built.lookups = [kept, light, staged = &scene](Isa isa) {
        return tree_lookups(kept, light, *staged, isa);
    };
    built.point_lookups = [kept](Isa isa) { return tree_point_lookups(kept, isa); };
    return built;
}

}  // namespace obscura
