#include "bench/shadows/shadow_rays.h"

#include <optional>

#include "bench/embree/embree_scene.h"
#include "bench/harness/run_times.h"
#include "core/parallel.h"
#include "raster/view.h"

namespace obscura {
namespace {

struct RayState {
    const VisiblePoints* points = nullptr;
    std::vector<std::uint8_t>* shown = nullptr;
    Exec exec;
    Vec3f eye, to_light;
    float offset_m = 0;
    EmbreeDevice device;
    std::optional<EmbreeScene> scene;

    explicit RayState(const Exec& exec_) : exec(exec_), device(exec_.threads) {}
};

/// The rays of 16 samples: columns first_column .. +3 of the block's four rows.
struct ShadowPacket {
    RTCRay16 rays;
    alignas(64) int valid[16];
    bool any = false;
};

int sample_of(int first_column, int lane) {
    return lane / 4 * frame_tile_side + first_column + lane % 4;
}

void aim(const RayState& state, const SurfaceBlock& s, int first_column, ShadowPacket& packet) {
    packet.any = false;
    for (int i = 0; i < 16; ++i) {
        const int at = sample_of(first_column, i);
        packet.rays.org_x[i] = s.px[at] + state.eye.x + state.offset_m * s.gx[at];
        packet.rays.org_y[i] = s.py[at] + state.eye.y + state.offset_m * s.gy[at];
        packet.rays.org_z[i] = s.pz[at] + state.eye.z + state.offset_m * s.gz[at];
        packet.rays.dir_x[i] = state.to_light.x;
        packet.rays.dir_y[i] = state.to_light.y;
        packet.rays.dir_z[i] = state.to_light.z;
        packet.rays.tnear[i] = 0.0f;
        packet.rays.tfar[i] = 1e30f;
        packet.rays.time[i] = 0.0f;
        packet.rays.mask[i] = ~0u;
        packet.rays.id[i] = 0;
        packet.rays.flags[i] = 0;
        const bool faces =
            s.gx[at] * state.to_light.x + s.gy[at] * state.to_light.y + s.gz[at] * state.to_light.z > 0;
        const bool asks = faces && is_covered(s, at);
        packet.valid[i] = asks ? -1 : 0;
        packet.any = packet.any || asks;
    }
}

void trace_packets(const RayState& state, std::size_t b) {
    const SurfaceBlock& s = state.points->blocks[b];
    ShadowPacket packet;
    for (int column = 0; column < frame_tile_side; column += 4) {
        aim(state, s, column, packet);
        if (!packet.any) continue;
        RTCIntersectContext context = coherent_context();
        rtcOccluded16(packet.valid, state.scene->handle(), &context, &packet.rays);
        // Embree marks an occluded ray by tfar = -inf.
        for (int i = 0; i < 16; ++i) {
            const bool lit = packet.valid[i] != 0 && !(packet.rays.tfar[i] < 0);
            (*state.shown)[state.points->pixel(b, sample_of(column, i))] = lit ? 1 : 0;
        }
    }
}

void trace_single(const RayState& state, std::size_t b) {
    const SurfaceBlock& s = state.points->blocks[b];
    ShadowPacket packet;
    for (int column = 0; column < frame_tile_side; column += 4) {
        aim(state, s, column, packet);
        for (int i = 0; i < 16; ++i) {
            if (packet.valid[i] == 0) continue;
            RTCIntersectContext context = coherent_context();
            RTCRay ray{};
            ray.org_x = packet.rays.org_x[i];
            ray.org_y = packet.rays.org_y[i];
            ray.org_z = packet.rays.org_z[i];
            ray.dir_x = packet.rays.dir_x[i];
            ray.dir_y = packet.rays.dir_y[i];
            ray.dir_z = packet.rays.dir_z[i];
            ray.tfar = packet.rays.tfar[i];
            ray.mask = ~0u;
            rtcOccluded1(state.scene->handle(), &context, &ray);
            (*state.shown)[state.points->pixel(b, sample_of(column, i))] = ray.tfar < 0 ? 0 : 1;
        }
    }
}

}  // namespace

Session open_shadow_rays(const Mesh& mesh, const VisiblePoints& points, Vec3d to_light,
                         std::vector<std::uint8_t>& shown, const Exec& exec, double off) {
    const auto state = std::make_shared<RayState>(exec);
    state->points = &points;
    state->shown = &shown;
    state->eye = to_float(points.eye);
    state->to_light = to_float(to_light);
    const Bounds bounds = bounds_of(mesh);
    state->offset_m = static_cast<float>(off * length(bounds.high - bounds.low));
    Session session;
    session.version = state->device.version();
    session.prepare_ms =
        milliseconds_of([&] { state->scene.emplace(state->device, mesh, RTC_SCENE_FLAG_NONE); });
    session.prepare_mib = state->device.mib();

    const auto for_blocks = [s = state.get()](void (*trace)(const RayState&, std::size_t)) {
        return [s, trace] {
            parallel_for(s->points->blocks.size(), s->exec, [&](std::size_t b) { trace(*s, b); });
        };
    };
    session.jobs = {{Workload::lookup, "packets of 16 rays", true, for_blocks(trace_packets), {}},
                    {Workload::lookup, "single rays", true, for_blocks(trace_single), {}}};
    session.state = state;
    return session;
}

}  // namespace obscura
