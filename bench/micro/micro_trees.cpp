// Lookups in serialised trees, for the points that a view of 1920 x 1080 pixels sees.
//   build/release/bench/micro/obscura_micro_bench --benchmark_filter=Tree
// Items are lookups; one thread.

#include "bench/micro/micro_trees.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <string>

#include "app/frame/scene_light.h"
#include "bench/shadows/scenes.h"
#include "bench/shadows/visible_points.h"
#include "filters/shadow_lookup.h"
#include "filters/tree_pcf.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/query.h"
#include "raster/view.h"

namespace obscura {
namespace {

struct TreeScene {
    Scene scene;
    VisiblePoints points;
};

const TreeScene& city_view() {
    static const TreeScene made = [] {
        TreeScene t;
        t.scene = stage_shadows(shadow_recipes(std::nullopt, true).front(), {});
        t.points = visible_points(t.scene, Exec{});
        return t;
    }();
    return made;
}

const ShadowTree& city_tree(int resolution, int top_levels) {
    static std::map<std::pair<int, int>, ShadowTree> made;
    static std::map<int, MultiresTree> built;
    const auto found = made.find({resolution, top_levels});
    if (found != made.end()) return found->second;
    const Scene& scene = city_view().scene;
    const LightView view =
        orthographic_light_view(bounds_of(scene.mesh), scene.lights[0].light.direction, resolution);
    if (!built.contains(resolution)) built[resolution] = build_shadow_tree(scene.mesh, view, {}, Exec{});
    ShadowTree& tree = made[{resolution, top_levels}];
    return tree = encode_tree(built[resolution], view, {TreeLayout::words24, top_levels});
}

struct Lookups {
    std::vector<std::int32_t> x, y;
    std::vector<float> depth;
    std::vector<std::uint16_t> lit;
    MapPoints view() const { return {x.data(), y.data(), depth.data(), x.size()}; }
};

/// Covered points that face the light, in squares of 4 x 4 pixels.
Lookups lookups_in(const LightView& view) {
    const TreeScene& city = city_view();
    const Vec3d to_light = -city.scene.lights[0].light.direction;
    Lookups l;
    for (const SurfaceBlock& b : city.points.blocks) {
        for (int i = 0; i < block_samples; ++i) {
            const int at = i % 16 / 4 * frame_tile_side + i / 16 * 4 + i % 4;
            const Vec3d normal = to_double(Vec3f{b.gx[at], b.gy[at], b.gz[at]});
            if (!is_covered(b, at) || dot(normal, to_light) <= 0) continue;
            const Vec3d p =
                to_map_space(view, city.points.eye + to_double(Vec3f{b.px[at], b.py[at], b.pz[at]}));
            l.x.push_back(static_cast<std::int32_t>(std::floor(p.x)));
            l.y.push_back(static_cast<std::int32_t>(std::floor(p.y)));
            l.depth.push_back(static_cast<float>(p.z));
        }
    }
    l.lit.resize((l.x.size() + 15) / 16);
    return l;
}

void count_lookups(benchmark::State& state, std::size_t lookups) {
    state.SetItemsProcessed(static_cast<std::int64_t>(lookups) * state.iterations());
}

void Independent(benchmark::State& state) {
    const ShadowTree& tree = city_tree(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    Lookups l = lookups_in(tree.view);
    for (auto _ : state)
        OBSCURA_DISPATCH(best_isa(), visibility, tree.code, l.view(), 0, l.lit.data());
    count_lookups(state, l.x.size());
}

void Coherent(benchmark::State& state) {
    const ShadowTree& tree = city_tree(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    Lookups l = lookups_in(tree.view);
    for (auto _ : state)
        OBSCURA_DISPATCH(best_isa(), coherent_visibility, tree.code, l.view(), 0, l.lit.data());
    count_lookups(state, l.x.size());
}

/// Samples that were looked up: those that face the light.
std::size_t asking_samples(const PcfLight& light) {
    std::size_t count = 0;
    for (const SurfaceBlock& b : city_view().points.blocks) {
        for (int at = 0; at < block_samples; ++at)
            count += ref::pcf_place(b, light, at).asks() ? 1 : 0;
    }
    return count;
}

template <class Run>
void filter_all(benchmark::State& state, const PcfLight& light, Run&& run) {
    const std::size_t asking = asking_samples(light);
    alignas(64) float visibility[block_samples];
    for (auto _ : state) {
        for (const SurfaceBlock& b : city_view().points.blocks) {
            run(b, visibility);
            benchmark::DoNotOptimize(visibility);
        }
    }
    count_lookups(state, asking);
}

PcfLight tree_light(const benchmark::State& state) {
    const Scene& scene = city_view().scene;
    const auto resolution = static_cast<int>(state.range(0));
    return pcf_light(shadow_light(scene, resolution, static_cast<int>(state.range(1))),
                     std::span(&city_tree(resolution, static_cast<int>(state.range(2))), 1),
                     scene.camera.eye);
}

void PcfShared(benchmark::State& state) {
    const PcfLight light = tree_light(state);
    filter_all(state, light, [&](const SurfaceBlock& b, float* v) {
        OBSCURA_DISPATCH(best_isa(), tree_pcf_block, b, light, v);
    });
}

void PcfNaive(benchmark::State& state) {
    const PcfLight light = tree_light(state);
    filter_all(state, light, [&](const SurfaceBlock& b, float* v) {
        OBSCURA_DISPATCH(best_isa(), naive_tree_pcf_block, b, light, v);
    });
}

void PcfHierarchical(benchmark::State& state) {
    const Scene& scene = city_view().scene;
    PcfLight light = tree_light(state);
    filter_hierarchically(light, camera_rays(scene.camera, scene.render.width, scene.render.height));
    filter_all(state, light, [&](const SurfaceBlock& b, float* v) {
        OBSCURA_DISPATCH(best_isa(), tree_pcf_block, b, light, v);
    });
}

void PcfDense(benchmark::State& state) {
    const Scene& scene = city_view().scene;
    const auto resolution = static_cast<int>(state.range(0));
    const SceneLight of = shadow_light(scene, resolution, static_cast<int>(state.range(1)));
    static std::map<int, ShadowMap> made;
    if (!made.contains(resolution)) {
        RasterScratch scratch;
        build_shadow_map(scene.mesh, of, bounds_of(scene.mesh), Exec{}, scratch, made[resolution]);
    }
    const PcfLight light = pcf_light(of, made[resolution], scene.camera.eye);
    filter_all(state, light, [&](const SurfaceBlock& b, float* v) {
        OBSCURA_DISPATCH(best_isa(), pcf_block, b, light, v);
    });
}

}  // namespace

void add_tree_benchmarks() {
    for (const int resolution : {16384, 65536, 262144}) {
        for (const int top_levels : {0, 8}) {
            benchmark::RegisterBenchmark("Tree/independent/city", Independent)
                ->Args({resolution, top_levels})
                ->Unit(benchmark::kMillisecond);
            benchmark::RegisterBenchmark("Tree/coherent/city", Coherent)
                ->Args({resolution, top_levels})
                ->Unit(benchmark::kMillisecond);
        }
    }
    const auto add = [](const char* name, void (*run)(benchmark::State&),
                        const std::vector<std::int64_t>& args) {
        benchmark::RegisterBenchmark(name, run)->Args(args)->Unit(benchmark::kMillisecond);
    };
    for (const int side : {1, 3, 5}) {
        for (const int resolution : {4096, 16384})
            add("TreePcf/dense/city", PcfDense, {resolution, side});
        for (const int resolution : {16384, 65536, 262144}) {
            add("TreePcf/naive/city", PcfNaive, {resolution, side, 0});
            for (const int top_levels : {0, 8})
                add("TreePcf/shared/city", PcfShared, {resolution, side, top_levels});
            add("TreePcf/hierarchical/city", PcfHierarchical, {resolution, side, 0});
        }
    }
}

}  // namespace obscura
