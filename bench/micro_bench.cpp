// Stages of the rasterizer one by one, with Google Benchmark: where the time of a map goes.
//   build/release/bench/obscura_micro_bench --benchmark_filter=City

#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>
#include <string>

#include "app/obj_file.h"
#include "core/topology.h"
#include "raster/depth_map.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "scenes/random.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

/// side x side closed boxes of varied size on a slab: 12 triangles each.
Mesh box_city(int side) {
    Mesh mesh;
    Random random(1);
    const auto add = [&](Vec3d low, Vec3d high) { append_mesh(mesh, box(low, high)); };
    add({0.0, -1.0, 0.0}, {10.0 * side, 0.0, 10.0 * side});
    for (int i = 0; i < side * side; ++i) {
        const double x = 10.0 * (i % side) + random.range(0.5, 3),
                     z = 10.0 * (i / side) + random.range(0.5, 3);
        add({x, 0.0, z}, {x + random.range(3, 6.5), random.range(3, 30), z + random.range(3, 6.5)});
    }
    analyse_topology(mesh);
    return mesh;
}

/// A scan from the data folder on a slab; empty when the folder is not there.
Mesh scan(const std::string& name) {
    const std::filesystem::path root = OBSCURA_SOURCE_DIR "/../shared/data";
    if (!std::filesystem::exists(root / name)) return {};
    Mesh mesh = load_obj(root / name, FileAccess{root, {}}, Limits{}).mesh;
    const Bounds b = bounds_of(mesh);
    const Vec3d side = (b.high - b.low) * 0.2;
    Mesh slab = box({b.low.x - side.x, b.low.y - side.y, b.low.z - side.z},
                    {b.high.x + side.x, b.low.y, b.high.z + side.z});
    analyse_topology(slab);
    append_mesh(mesh, slab);
    return mesh;
}

const Mesh& mesh_named(const std::string& name) {
    static std::map<std::string, Mesh> made;
    if (!made.contains(name)) {
        made[name] =
            name == "city" ? box_city(30) : (name == "bigcity" ? box_city(222) : scan("meshes/bunny.obj"));
    }
    return made[name];
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
        bin_records(setup, 4096, 4096, 64, s.exec, bins);
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

#define OBSCURA_MICRO(stage)                                                                              \
    BENCHMARK_CAPTURE(stage, City, "city")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime(); \
    BENCHMARK_CAPTURE(stage, BigCity, "bigcity")                                                          \
        ->Arg(1)                                                                                          \
        ->Arg(2)                                                                                          \
        ->Unit(benchmark::kMillisecond)                                                                   \
        ->UseRealTime();                                                                                  \
    BENCHMARK_CAPTURE(stage, Bunny, "bunny")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime()
OBSCURA_MICRO(Setup);
OBSCURA_MICRO(Bin);
OBSCURA_MICRO(DepthMap);
OBSCURA_MICRO(IntervalMap);

}  // namespace
}  // namespace obscura

BENCHMARK_MAIN();
