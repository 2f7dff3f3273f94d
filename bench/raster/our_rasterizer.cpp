#include "bench/raster/our_rasterizer.h"

#include <fmt/format.h>

#include <cstring>
#include <memory>

#include "app/frame/render_frame.h"
#include "core/buffer.h"
#include "raster/depth_map.h"
#include "raster/interval_map.h"

namespace obscura {
namespace {

struct OurState {
    const BenchScene* bench = nullptr;
    Exec exec;
    RasterScratch scratch;
    Raster<float> depth;
    Raster<DepthInterval> intervals;
    FrameCache cache;
    Frame frame;
};

void draw_depth(OurState& s, Culling culling) {
    SetupParams params;
    params.culling = culling;
    depth_map(s.bench->scene.mesh, s.bench->light, params, s.exec, s.scratch, s.depth.view());
}

void draw_intervals(OurState& s) {
    interval_map(s.bench->scene.mesh, s.bench->light, {}, s.exec, s.scratch, s.intervals.view());
}

void draw_frame(OurState& s, bool light_moved) {
    // A map that was made for another resolution is made again, in the memory it has.
    for (LightShadow& shadow : s.cache.shadows) {
        if (light_moved) shadow.light.shadow.resolution = 0;
    }
    render_frame(s.bench->scene, {}, s.exec, s.cache, s.frame);
}

void deliver_intervals(const OurState& s, float* result) {
    const std::size_t texels = s.intervals.pixels.size();
    for (std::size_t i = 0; i < texels; ++i) {
        result[i] = s.intervals.pixels[i].entry;
        result[texels + i] = s.intervals.pixels[i].exit;
    }
}

Session open_ours(const BenchScene& bench, const Exec& exec) {
    const auto state = std::make_shared<OurState>();
    OurState& s = *state;
    s.bench = &bench;
    s.exec = exec;
    s.depth.reset(bench.light.width, bench.light.height);
    s.intervals.reset(bench.light.width, bench.light.height);
    const auto deliver_depth = [&s](float* r) {
        std::memcpy(r, s.depth.pixels.data(), s.depth.pixels.size() * sizeof(float));
    };
    const auto deliver_frame = [&s](float* r) {
        std::memcpy(r, s.frame.radiance.pixels.data(), s.frame.radiance.pixels.size() * sizeof(Vec3f));
    };
    Session session;
    session.version = fmt::format("this build ({})", isa_name(exec.isa));
    session.prepare_ms = bench.topology_ms;
    session.jobs = {
        {Workload::depth, "all faces", true, [&s] { draw_depth(s, Culling::none); }, deliver_depth},
        {Workload::depth, "back faces dropped", true, [&s] { draw_depth(s, Culling::back_faces); },
         deliver_depth},
        {Workload::dual_depth, "entry and exit, full counter", true, [&s] { draw_intervals(s); },
         [&s](float* r) { deliver_intervals(s, r); }},
        {Workload::frame, "Lambert + GGX, interval map, 1 tap", true, [&s] { draw_frame(s, true); },
         deliver_frame},
        {Workload::static_frame, "Lambert + GGX, 1 tap, map kept", true, [&s] { draw_frame(s, false); },
         deliver_frame},
    };
    session.state = state;
    return session;
}

}  // namespace

Contestant our_contestant() {
    return {"Obscura", "", open_ours};
}

}  // namespace obscura
