#include "bench/shadow_methods.h"

#include <chrono>
#include <memory>
#include <span>
#include <utility>

#include "bench/dense_points.h"
#include "bench/map_points.h"
#include "filters/shadow_lookup.h"
#include "hierarchy/build.h"
#include "hierarchy/query.h"
#include "hierarchy/shadow_tree.h"
#include "raster/shadow_map.h"

namespace obscura {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr std::pair<const char*, int> kernels[] = {{"1 tap", 1}, {"3x3", 3}, {"5x5", 5}};

/// A lookup with a kernel of one texel.
void look_up_block(const ShadowTree& tree, const PcfLight& light, Isa isa, const SurfaceBlock& surface,
                   float* visible) {
    alignas(64) std::int32_t x[block_samples], y[block_samples];
    alignas(64) float depth[block_samples];
    alignas(64) std::uint16_t lit[block_groups];
    std::uint32_t asked[block_groups] = {};
    for (int at = 0; at < block_samples; ++at) {
        const TestedTexel t = tested_texel(surface, light, at);
        x[at] = t.x;
        y[at] = t.y;
        depth[at] = t.depth;
        asked[at / 16] |= (t.looked_up ? 1u : 0u) << (at % 16);
    }
    OBSCURA_DISPATCH(isa, visibility, tree.code, (MapPoints{x, y, depth, block_samples}), 0, lit);
    for (int at = 0; at < block_samples; ++at)
        visible[at] = (lit[at / 16] & asked[at / 16]) >> (at % 16) & 1 ? 1.0f : 0.0f;
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
    const auto tree =
        std::make_shared<const ShadowTree>(encode_tree(build_shadow_tree(scene.mesh, view, {}, exec), view));
    BuiltShadow built;
    built.build_s = seconds_since(start);
    built.view = view;
    built.bytes = static_cast<std::int64_t>(tree->bytes);
    built.light = pcf_light(light, std::span(&view, 1), scene.camera.eye);
    built.lookups = [tree, pcf = built.light](Isa isa) -> std::vector<ShadowLookup> {
        return {{"1 tap", [tree, pcf, isa](const SurfaceBlock& surface, float* visibility) {
                     look_up_block(*tree, pcf, isa, surface, visibility);
                 }}};
    };
    built.point_lookups = [tree](Isa isa) -> std::vector<PointLookup> {
        return {{"points",
                 [tree, isa](const MapPoints& points, std::uint16_t* lit) {
                     OBSCURA_DISPATCH(isa, visibility, tree->code, points, 0, lit);
                 }},
                {"points, coherent", [tree, isa](const MapPoints& points, std::uint16_t* lit) {
                     OBSCURA_DISPATCH(isa, coherent_visibility, tree->code, points, 0, lit);
                 }}};
    };
    return built;
}

}  // namespace obscura
