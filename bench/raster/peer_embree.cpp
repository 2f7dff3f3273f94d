// Embree 3 (Wald, Woop, Benthin, Johnson, Ernst, "Embree: A Kernel Framework for Efficient CPU Ray Tracing",
// 2014) used the way its manual recommends for primary and shadow rays: packets of 16 over 4 x 4 pixels with
// the coherent flag, one static triangle mesh, default build quality.

#include "bench/raster/peer_embree.h"

#include <cstring>
#include <optional>

#include "bench/embree/embree_scene.h"
#include "bench/harness/run_times.h"
#include "bench/raster/phong_scene.h"
#include "bench/raster/views.h"
#include "core/image.h"
#include "core/parallel.h"

namespace obscura {
namespace {

constexpr int packet_side = 4;
constexpr float nothing = 1.0f;

/// Everything the jobs share; lives as long as the session.
struct EmbreeState {
    const BenchScene* bench = nullptr;
    Exec exec;
    EmbreeDevice device;
    std::optional<EmbreeScene> scene;           ///< for plain rays
    std::optional<EmbreeScene> filtered_scene;  ///< the same mesh, for rays with a filter
    RayGrid light_rays, camera_rays;
    std::vector<float> normals;
    PhongScene phong;
    const PhongKernels* kernels = nullptr;
    Image<float> first, second;
    Image<Vec3f> frame;

    EmbreeState(const BenchScene& bench_, const Exec& exec_)
        : bench(&bench_), exec(exec_), device(exec_.threads) {}
};

/// A packet of rays and which of its lanes lie inside the picture.
struct Packet {
    RTCRayHit16 rays;
    alignas(64) int valid[16];
};

/// The rays of the 4 x 4 texels from (x0, y0) on; lane i is texel (x0 + i % 4, y0 + i / 4).
void aim(Packet& p, const RayGrid& grid, int x0, int y0, int width, int height) {
    const auto corner = [&](Vec3d base, Vec3d dx, Vec3d dy) {
        return to_float(base + dx * static_cast<double>(x0) + dy * static_cast<double>(y0));
    };
    const Vec3f org = corner(grid.origin, grid.origin_dx, grid.origin_dy);
    const Vec3f dir = corner(grid.direction, grid.direction_dx, grid.direction_dy);
    const Vec3f odx = to_float(grid.origin_dx), ody = to_float(grid.origin_dy);
    const Vec3f ddx = to_float(grid.direction_dx), ddy = to_float(grid.direction_dy);
    for (int i = 0; i < 16; ++i) {
        const int column = i % packet_side, row = i / packet_side;
        const auto x = static_cast<float>(column), y = static_cast<float>(row);
        p.rays.ray.org_x[i] = org.x + x * odx.x + y * ody.x;
        p.rays.ray.org_y[i] = org.y + x * odx.y + y * ody.y;
        p.rays.ray.org_z[i] = org.z + x * odx.z + y * ody.z;
        p.rays.ray.dir_x[i] = dir.x + x * ddx.x + y * ddy.x;
        p.rays.ray.dir_y[i] = dir.y + x * ddx.y + y * ddy.y;
        p.rays.ray.dir_z[i] = dir.z + x * ddx.z + y * ddy.z;
        p.rays.ray.tnear[i] = 0.0f;
        p.rays.ray.tfar[i] = nothing;
        p.rays.ray.time[i] = 0.0f;
        p.rays.ray.mask[i] = ~0u;
        p.rays.ray.id[i] = static_cast<unsigned>(i);
        p.rays.ray.flags[i] = 0;
        p.rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        p.rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        p.valid[i] = x0 + column < width && y0 + row < height ? -1 : 0;
    }
}

/// Writes 16 lanes to their texels.
void store(Image<float>& map, int x0, int y0, const float* values) {
    for (int i = 0; i < 16; ++i) {
        const int x = x0 + i % packet_side, y = y0 + i / packet_side;
        if (x < map.width && y < map.height) map(x, y) = values[i];
    }
}

/// Calls fn(x0, y0) for every 4 x 4 block; one row of blocks is one work item.
template <class Fn>
void for_each_block(int width, int height, const Exec& exec, const Fn& fn) {
    const int rows = (height + packet_side - 1) / packet_side;
    parallel_for(static_cast<std::size_t>(rows), exec, [&](std::size_t row) {
        for (int x0 = 0; x0 < width; x0 += packet_side)
            fn(x0, static_cast<int>(row) * packet_side);
    });
}

void trace_depth(EmbreeState& state) {
    Image<float>& map = state.first;
    for_each_block(map.width, map.height, state.exec, [&](int x0, int y0) {
        Packet p;
        aim(p, state.light_rays, x0, y0, map.width, map.height);
        RTCIntersectContext context = coherent_context();
        rtcIntersect16(p.valid, state.scene->handle(), &context, &p.rays);
        store(map, x0, y0, p.rays.ray.tfar);
    });
}

// Dual depth by two rays: the second starts at the next float behind the first hit.
void trace_dual_restart(EmbreeState& state) {
    const int width = state.first.width, height = state.first.height;
    for_each_block(width, height, state.exec, [&](int x0, int y0) {
        Packet p;
        aim(p, state.light_rays, x0, y0, width, height);
        RTCIntersectContext context = coherent_context();
        rtcIntersect16(p.valid, state.scene->handle(), &context, &p.rays);
        store(state.first, x0, y0, p.rays.ray.tfar);
        for (int i = 0; i < 16; ++i) {
            const bool hit = p.rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
            p.valid[i] = hit ? p.valid[i] : 0;
            p.rays.ray.tnear[i] = p.rays.ray.tfar[i] * (1.0f + 0x1p-22f);
            p.rays.ray.tfar[i] = nothing;
            p.rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect16(p.valid, state.scene->handle(), &context, &p.rays);
        store(state.second, x0, y0, p.rays.ray.tfar);
    });
}

/// Context of rays that keep two hits. `base` comes first: Embree hands its address back to the filter.
struct TwoHits {
    RTCIntersectContext base;
    alignas(64) float first[16], second[16];
};

// A candidate becomes first or second. It is accepted, which shortens the ray, only when it is the new second
// hit: nothing behind that matters, while a new first hit must leave the ray long enough for the old one's
// rivals.
void keep_two_hits(const RTCFilterFunctionNArguments* args) {
    auto& two = *reinterpret_cast<TwoHits*>(args->context);
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        const unsigned id = RTCRayN_id(args->ray, args->N, lane);
        const float t = RTCRayN_tfar(args->ray, args->N, lane);
        args->valid[lane] = 0;
        if (t < two.first[id]) {
            two.second[id] = two.first[id];
            two.first[id] = t;
        } else if (t > two.first[id] && t < two.second[id]) {
            two.second[id] = t;
            args->valid[lane] = -1;
        }
    }
}

void trace_dual_filter(EmbreeState& state) {
    const int width = state.first.width, height = state.first.height;
    for_each_block(width, height, state.exec, [&](int x0, int y0) {
        Packet p;
        aim(p, state.light_rays, x0, y0, width, height);
        TwoHits two;
        two.base = coherent_context();
        two.base.filter = keep_two_hits;
        for (int i = 0; i < 16; ++i)
            two.first[i] = two.second[i] = nothing;
        rtcIntersect16(p.valid, state.filtered_scene->handle(), &two.base, &p.rays);
        store(state.first, x0, y0, two.first);
        store(state.second, x0, y0, two.second);
    });
}

/// Traces the shadow rays of the lanes that face the light and fills `lit`.
void trace_shadows(const EmbreeState& state, PhongPacket& phong) {
    RTCRay16 rays;
    alignas(64) int valid[16];
    for (int i = 0; i < 16; ++i) {
        rays.org_x[i] = phong.shadow_x[i];
        rays.org_y[i] = phong.shadow_y[i];
        rays.org_z[i] = phong.shadow_z[i];
        rays.dir_x[i] = state.phong.to_light[0];
        rays.dir_y[i] = state.phong.to_light[1];
        rays.dir_z[i] = state.phong.to_light[2];
        rays.tnear[i] = 0.0f;
        rays.tfar[i] = 1e30f;
        rays.time[i] = 0.0f;
        rays.mask[i] = ~0u;
        rays.id[i] = 0;
        rays.flags[i] = 0;
        valid[i] = phong.n_dot_l[i] > 0.0f ? -1 : 0;
    }
    RTCIntersectContext context = coherent_context();
    rtcOccluded16(valid, state.scene->handle(), &context, &rays);
    // Embree marks an occluded ray by tfar = -inf.
    for (int i = 0; i < 16; ++i)
        phong.lit[i] = rays.tfar[i] < 0.0f ? 0.0f : 1.0f;
}

void trace_frame(EmbreeState& state) {
    Image<Vec3f>& frame = state.frame;
    for_each_block(frame.width, frame.height, state.exec, [&](int x0, int y0) {
        Packet p;
        aim(p, state.camera_rays, x0, y0, frame.width, frame.height);
        for (float& tfar : p.rays.ray.tfar)
            tfar = 1e30f;
        RTCIntersectContext context = coherent_context();
        rtcIntersect16(p.valid, state.scene->handle(), &context, &p.rays);

        PhongPacket phong;
        std::memcpy(phong.dir_x, p.rays.ray.dir_x, sizeof phong.dir_x);
        std::memcpy(phong.dir_y, p.rays.ray.dir_y, sizeof phong.dir_y);
        std::memcpy(phong.dir_z, p.rays.ray.dir_z, sizeof phong.dir_z);
        for (int i = 0; i < 16; ++i) {
            const bool hit = p.valid[i] != 0 && p.rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
            phong.triangle[i] = hit ? p.rays.hit.primID[i] : no_hit;
            phong.t[i] = hit ? p.rays.ray.tfar[i] : 0.0f;
            phong.u[i] = hit ? p.rays.hit.u[i] : 0.0f;
            phong.v[i] = hit ? p.rays.hit.v[i] : 0.0f;
        }
        state.kernels->surface(state.phong, phong);
        trace_shadows(state, phong);
        state.kernels->shade(state.phong, phong);
        for (int i = 0; i < 16; ++i) {
            const int x = x0 + i % packet_side, y = y0 + i / packet_side;
            if (p.valid[i] != 0) frame(x, y) = {phong.r[i], phong.g[i], phong.b[i]};
        }
    });
}

const PhongKernels* kernels_for(Isa isa) {
    switch (isa) {
        case Isa::avx512bw:
            return &avx512bw::phong;
        case Isa::avx2:
            return &avx2::phong;
        case Isa::sse2:
        case Isa::ref:
            break;
    }
    return &sse2::phong;
}

void deliver_maps(const EmbreeState& state, bool dual, float* result) {
    const std::size_t texels = state.first.pixels.size();
    std::memcpy(result, state.first.pixels.data(), texels * sizeof(float));
    if (dual) std::memcpy(result + texels, state.second.pixels.data(), texels * sizeof(float));
}

std::vector<Job> jobs_of(EmbreeState& s) {
    const auto run_frame = [&s] { trace_frame(s); };
    const auto read_frame = [&s](float* r) {
        std::memcpy(r, s.frame.pixels.data(), s.frame.pixels.size() * sizeof(Vec3f));
    };
    return {
        {Workload::depth, "packets of 16 rays", true, [&s] { trace_depth(s); },
         [&s](float* r) { deliver_maps(s, false, r); }},
        {Workload::dual_depth, "second ray behind the first hit", true, [&s] { trace_dual_restart(s); },
         [&s](float* r) { deliver_maps(s, true, r); }},
        {Workload::dual_depth, "one ray, filter keeps two hits", true, [&s] { trace_dual_filter(s); },
         [&s](float* r) { deliver_maps(s, true, r); }},
        {Workload::frame, "Phong + shadow ray, BVH kept", true, run_frame, read_frame},
        // Its BVH serves any light: for Embree both frames are one.
        {Workload::static_frame, "Phong + shadow ray, BVH kept", true, run_frame, read_frame},
    };
}

Session open_embree(const BenchScene& bench, const Exec& exec) {
    const auto state = std::make_shared<EmbreeState>(bench, exec);
    const Mesh& mesh = bench.scene.mesh;
    Session session;
    session.version = state->device.version();
    session.prepare_ms =
        milliseconds_of([&] { state->scene.emplace(state->device, mesh, RTC_SCENE_FLAG_NONE); });
    session.prepare_mib = state->device.mib();
    state->filtered_scene.emplace(state->device, mesh, RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);

    const RenderSettings& render = bench.scene.render;
    state->light_rays = rays_of(bench.light);
    state->camera_rays = rays_of(bench.scene.camera, render.width, render.height);
    state->normals = corner_normals(mesh);
    state->phong = phong_constants(bench);
    state->phong.normals = state->normals.data();
    state->kernels = kernels_for(exec.isa);
    state->first = Image<float>(bench.light.width, bench.light.height);
    state->second = Image<float>(bench.light.width, bench.light.height);
    state->frame = Image<Vec3f>(render.width, render.height);

    session.jobs = jobs_of(*state);
    session.state = state;
    return session;
}

}  // namespace

Contestant embree_contestant() {
    return {"Embree", "", open_embree};
}

}  // namespace obscura
