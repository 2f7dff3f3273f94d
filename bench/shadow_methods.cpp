#include "bench/shadow_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/dense_points.h"
#include "filters/shadow_lookup.h"
#include "filters/tree_pcf.h"
#include "hierarchy/build.h"
#include "hierarchy/decode.h"
#include "hierarchy/query.h"
#include "hierarchy/shadow_tree.h"
#include "raster/shadow_map.h"

namespace obscura {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Of the tree with a grid: 2^8 squared entries of 8 bytes, 512 KiB, which the second-level cache holds.
constexpr std::int32_t top_grid_levels = 8;

constexpr std::pair<const char*, int> kernels[] = {{"1 tap", 1}, {"3x3", 3}, {"5x5", 5}};

/// A tree, and the same with a dense top grid.
struct BuiltTree {
    std::vector<ShadowTree> plain, with_grid;  ///< one each: pcf_light() wants a span
};

void look_up(const PcfLight& light, Isa isa, bool naive, const SurfaceBlock& surface, float* visible) {
    if (naive) {
        OBSCURA_DISPATCH(isa, naive_tree_pcf_block, surface, light, visible);
    } else {
        OBSCURA_DISPATCH(isa, pcf_block, surface, light, visible);
    }
}

std::vector<ShadowLookup> tree_lookups(const std::shared_ptr<const BuiltTree>& trees, const Light& light,
                                       Vec3d eye, Isa isa) {
    std::vector<ShadowLookup> lookups;
    const auto add = [&](const std::string& name, const std::vector<ShadowTree>& tree, int side, bool naive) {
        PcfLight pcf = pcf_light(light, tree, eye);
        pcf.side = side;
        lookups.push_back({name, [trees, pcf, isa, naive](const SurfaceBlock& surface, float* visible) {
                               look_up(pcf, isa, naive, surface, visible);
                           }});
    };
    for (const auto& [name, side] : kernels) {
        add(name, trees->plain, side, false);
        add(fmt::format("{}, top grid", name), trees->with_grid, side, false);
        if (side > 1) add(fmt::format("{}, naive", name), trees->plain, side, true);
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
    add("points", trees->plain[0], false);
    add("points, coherent", trees->plain[0], true);
    add("points, top grid", trees->with_grid[0], false);
    add("points, top grid, coherent", trees->with_grid[0], true);
    return lookups;
}

}  // namespace

BuiltShadow build_dense(const Scene& scene, int size, const Exec& exec) {
    const Light light = shadow_light(scene, size, 1);
    const auto start = Clock::now();
    const auto map = std::make_shared<ShadowMap>();
    {
        RasterScratch scratch;
        build_shadow_map(scene.mesh, light, bounds_of(scene.mesh), exec, scratch, *map);
    }
    BuiltShadow built;
    built.build_s = seconds_since(start);
    built.view = map->views[0];
    built.bytes = dense_map_bytes(light);
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
    const Light light = shadow_light(scene, size, 1);
    const auto start = Clock::now();
    const LightView view = shadow_views(light, bounds_of(scene.mesh))[0];
    const auto trees = std::make_shared<BuiltTree>();
    trees->plain.push_back(encode_tree(build_shadow_tree(scene.mesh, view, {}, exec), view));
    BuiltShadow built;
    built.build_s = seconds_since(start);
    trees->with_grid = trees->plain;
    set_top_grid(trees->with_grid[0], std::min(trees->plain[0].code.levels, top_grid_levels));
    built.view = view;
    built.bytes = static_cast<std::int64_t>(trees->plain[0].bytes);
    built.light = pcf_light(light, trees->plain, scene.camera.eye);
    const std::shared_ptr<const BuiltTree> kept = trees;
    built.lookups = [kept, light, eye = scene.camera.eye](Isa isa) {
        return tree_lookups(kept, light, eye, isa);
    };
    built.point_lookups = [kept](Isa isa) { return tree_point_lookups(kept, isa); };
    return built;
}

}  // namespace obscura
