// Stages of the rasterizer and lookups in trees one by one, with Google Benchmark: where the time goes.
//   build/release/bench/micro/obscura_micro_bench --benchmark_filter=city

#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "bench/harness/recipes.h"
#include "bench/micro/micro_trees.h"
#include "core/topology.h"
#include "raster/depth_map.h"
#include "raster/interval_map.h"
#include "raster/view.h"

namespace obscura {
namespace {

const Mesh& mesh_named(const std::string& name) {
    static std::map<std::string, Mesh> made;
    const auto found = made.find(name);
    if (found != made.end()) return found->second;
    Mesh& mesh = made[name];
    const std::filesystem::path data = OBSCURA_SOURCE_DIR "/../shared/data";
    for (const BenchRecipe& recipe :
         bench_recipes(std::filesystem::exists(data) ? std::optional(data) : std::nullopt, false)) {
        if (recipe.name == name) mesh = recipe.make();
    }
    analyse_topology(mesh);
    return mesh;
}

struct Setting {
    const Mesh& mesh;
    LightView view;
    Exec exec;
};

Setting setting(const benchmark::State& state, const std::string& name) {
    const Mesh& mesh = mesh_named(name);
    return {mesh, orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.4, -1, 0.3}), 4096),
            Exec{best_isa(), static_cast<int>(state.range(0))}};
}

void Setup(benchmark::State& state, const std::string& name) {
    const Setting s = setting(state, name);
    TriangleSetup setup;
    for (auto _ : state)
        setup_triangles(s.mesh, s.view, {}, s.exec, setup);
    state.counters["triangles"] = static_cast<double>(s.mesh.triangles.size());
}

void Bin(benchmark::State& state, const std::string& name) {
    const Setting s = setting(state, name);
    TriangleSetup setup;
    TileBins bins;
    setup_triangles(s.mesh, s.view, {}, s.exec, setup);
    for (auto _ : state)
        bin_records(setup, {0, 0, 4096, 4096}, 64, s.exec, bins);
    state.counters["items"] = static_cast<double>(bins.items.size());
}

void DepthMap(benchmark::State& state, const std::string& name) {
    const Setting s = setting(state, name);
    RasterScratch scratch;
    Raster<float> out(4096, 4096);
    SetupParams params;
    params.culling = Culling::back_faces;
    for (auto _ : state)
        depth_map(s.mesh, s.view, params, s.exec, scratch, out.view());
}

void IntervalMap(benchmark::State& state, const std::string& name) {
    const Setting s = setting(state, name);
    RasterScratch scratch;
    Raster<DepthInterval> out(4096, 4096);
    for (auto _ : state)
        interval_map(s.mesh, s.view, {}, s.exec, scratch, out.view());
}

void add(const std::string& stage, void (*run)(benchmark::State&, const std::string&)) {
    for (const std::string scene : {"city", "bigcity", "town", "bunny", "bunny8"}) {
        std::string name = stage;
        name.append("/").append(scene);
        benchmark::RegisterBenchmark(name.c_str(), run, scene)
            ->Arg(1)
            ->Arg(2)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
    }
}

}  // namespace

void add_all() {
    add("Setup", Setup);
    add("Bin", Bin);
    add("DepthMap", DepthMap);
    add("IntervalMap", IntervalMap);
    add_tree_benchmarks();
}

}  // namespace obscura

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    obscura::add_all();
    benchmark::RunSpecifiedBenchmarks();
}
