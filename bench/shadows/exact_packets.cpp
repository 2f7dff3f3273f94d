// Embree's coherent occlusion rays for the samples that exact shadows look up. Built only with Embree.

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "app/frame/shadows.h"
#include "bench/embree/embree_scene.h"
#include "bench/harness/run_times.h"
#include "bench/shadows/exact_session.h"
#include "core/parallel.h"
#include "raster/exact/casters.h"
#include "raster/view.h"

namespace obscura {
namespace {

/// The mesh without what casts no shadow.
Mesh casting(const Mesh& mesh) {
    Mesh part;
    part.positions = mesh.positions;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.objects.empty() || mesh.objects[mesh.object[t]].casts_shadow)
            part.triangles.push_back(mesh.triangles[t]);
    }
    return part;
}

struct PacketState {
    const FrameSamples& samples;
    Exec exec;
    Mesh mesh;
    std::vector<ExactLight> lights;
    std::vector<float> near_m;
    std::vector<std::vector<std::uint32_t>> asking, lit;
    Vec3f eye;
    float offset_m = 0;  ///< 8 units in the last place of the largest coordinate
    EmbreeDevice device;
    std::optional<EmbreeScene> embree;
    double hierarchy_ms = 0;

    PacketState(const Scene& scene, const FrameSamples& samples_, const Exec& exec_)
        : samples(samples_), exec(exec_), mesh(casting(scene.mesh)), device(exec_.threads) {
        // Casters only tell which samples ask, light by light: there may be hundreds.
        CasterScratch scratch;
        for (const SceneLight& light : scene.lights) {
            if (!casts_shadows(light)) continue;
            std::vector<Casters> casters = build_casters(scene.mesh, light.light, exec, scratch);
            lights.push_back(exact_light(light.light, casters, scene.mesh, samples.rays));
            asking.push_back(asked_samples(samples, std::span(&lights.back(), 1), exec)[0]);
            for (ExactView& view : lights.back().view)
                view = {};
            for (Casters& view : casters)
                scratch.spare.push_back(std::move(view));
            near_m.push_back(static_cast<float>(light.light.near_m));
        }
        lit = asking;
        eye = to_float(scene.camera.eye);
        float largest = 0;
        for (const Vec3f& p : mesh.positions)
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        offset_m = 8 * largest * 0x1p-23f;
        hierarchy_ms = milliseconds_of([&] { embree.emplace(device, mesh, RTC_SCENE_FLAG_NONE); });
    }
};

/// Rays towards one light, from samples of one tile.
struct Packet {
    RTCRay16 rays;
    alignas(64) int valid[16];
    int at[16];
    bool any = false;
};

void aim(const PacketState& state, std::size_t light, const ExactPoints& s, const std::uint32_t* asking,
         Packet& packet) {
    const ExactLight& l = state.lights[light];
    packet.any = false;
    for (int i = 0; i < 16; ++i) {
        const int at = packet.at[i];
        packet.valid[i] = (asking[at / 16] >> (at % 16) & 1u) != 0 ? -1 : 0;
        packet.any = packet.any || packet.valid[i] != 0;
    }
    if (!packet.any) return;
    for (int i = 0; i < 16; ++i) {
        const int at = packet.at[i];
        const Vec3f p = to_float(Vec3d{s.px[at] - l.eye[0], s.py[at] - l.eye[1], s.pz[at] - l.eye[2]}),
                    normal{s.gx[at], s.gy[at], s.gz[at]};
        const float reach = (std::fabs(p.x) + std::fabs(p.y)) + std::fabs(p.z);
        const float offset = state.offset_m + l.snapping_m + l.snapping_per_m * reach;
        const Vec3f from = p + normal * offset;
        Vec3f to{l.to_light[0], l.to_light[1], l.to_light[2]};
        float far = 1e30f;
        if (!l.directional) {
            to = Vec3f{l.position[0], l.position[1], l.position[2]} - from;
            far = 1.0f - state.near_m[light] / length(to);
        }
        packet.rays.org_x[i] = from.x + state.eye.x;
        packet.rays.org_y[i] = from.y + state.eye.y;
        packet.rays.org_z[i] = from.z + state.eye.z;
        packet.rays.dir_x[i] = to.x;
        packet.rays.dir_y[i] = to.y;
        packet.rays.dir_z[i] = to.z;
        packet.rays.tnear[i] = 0.0f;
        packet.rays.tfar[i] = far;
        packet.rays.time[i] = 0.0f;
        packet.rays.mask[i] = ~0u;
        packet.rays.id[i] = 0;
        packet.rays.flags[i] = 0;
    }
}

/// Sixteen neighbours: 4 x 4 pixels, or 2 x 2 with four samples each (exact_point_index()).
void choose(int packet_index, Packet& packet) {
    for (int i = 0; i < 16; ++i)
        packet.at[i] = packet_index * 16 + i;
}

void trace_tile(PacketState& state, std::size_t tile) {
    const ExactPoints points = state.samples.points(tile);
    const std::size_t first_word = tile * state.samples.per_tile() / 16;
    Packet packet;
    for (std::size_t l = 0; l < state.lights.size(); ++l) {
        const std::uint32_t* asking = state.asking[l].data() + first_word;
        std::uint32_t* lit = state.lit[l].data() + first_word;
        for (std::int32_t p = 0; p < points.count / 16; ++p) {
            choose(p, packet);
            aim(state, l, points, asking, packet);
            if (!packet.any) continue;
            RTCIntersectContext context = coherent_context();
            rtcOccluded16(packet.valid, state.embree->handle(), &context, &packet.rays);
            for (int i = 0; i < 16; ++i) {
                const int at = packet.at[i];
                const std::uint32_t bit = 1u << (at % 16);
                // Embree marks an occluded ray by tfar = -inf.
                const bool is_lit = packet.valid[i] != 0 && !(packet.rays.tfar[i] < 0);
                lit[at / 16] = is_lit ? lit[at / 16] | bit : lit[at / 16] & ~bit;
            }
        }
    }
}

ExactFindings findings_of(const PacketState& state) {
    ExactFindings findings;
    for (std::size_t l = 0; l < state.lights.size(); ++l) {
        for (std::size_t i = 0; i < state.asking[l].size(); ++i) {
            findings.asked += std::popcount(state.asking[l][i]);
            findings.lit += std::popcount(state.lit[l][i]);
        }
    }
    return findings;
}

}  // namespace

TracedSamples trace_samples(const Scene& scene, const FrameSamples& samples, const Exec& exec) {
    PacketState state(scene, samples, exec);
    const double trace_ms = milliseconds_of(
        [&] { parallel_for(samples.tiles, exec, [&](std::size_t t) { trace_tile(state, t); }); });
    return {std::move(state.asking), std::move(state.lit), state.hierarchy_ms, trace_ms};
}

Session open_exact_rays(const Scene& scene, const FrameSamples& samples, const Exec& exec) {
    const auto state = std::make_shared<PacketState>(scene, samples, exec);
    Session session;
    session.version = state->device.version();
    session.prepare_mib = state->device.mib();
    session.jobs = {{Workload::shadow_map,
                     "hierarchy",
                     true,
                     [s = state.get()] { s->embree.emplace(s->device, s->mesh, RTC_SCENE_FLAG_NONE); },
                     {}},
                    {Workload::lookup, "packets of 16 rays", true,
                     [s = state.get()] {
                         parallel_for(s->samples.tiles, s->exec, [s](std::size_t t) { trace_tile(*s, t); });
                     },
                     [s = state.get()](float* to) { write_findings(findings_of(*s), to); }}};
    session.state = state;
    return session;
}

}  // namespace obscura
