#include "app/frame/day_shadow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "app/frame/shadow_text.h"
#include "app/frame/shadows.h"
#include "core/count_text.h"
#include "core/stopwatch.h"
#include "raster/exact/casters.h"
#include "raster/setup_memory.h"

namespace obscura {
namespace {

/// "07:12:33 (azimuth 72.1, ...)".
std::string sun_text(const FarSun& sun) {
    const auto seconds = static_cast<std::int64_t>(std::floor(sun.hour_h * 3600 + 0.5));
    return fmt::format("{:02}:{:02}:{:02} (azimuth {:.4f}, elevation {:.4f} degrees)", seconds / 3600,
                       seconds / 60 % 60, seconds % 60, sun.azimuth_deg, sun.elevation_deg);
}

const FarSun& sun_at(const FarDay& day, int sun) {
    return day.suns[static_cast<std::size_t>(sun)];
}

}  // namespace

void check_days(const Scene& scene,
                const std::function<void(std::size_t light, const std::string& why)>& refuse) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const SceneLight& light = scene.lights[i];
        if (light.shadow.method != ShadowMethod::day || !casts_shadows(light)) continue;
        const GroundDay& ground = *scene.days.at(light.light.id).ground;
        const NearestSun nearest = nearest_sun(ground.day, -normalize(light.light.direction));
        if (nearest.sun >= 0 && nearest.degrees <= light.shadow.max_sun_deg) continue;
        const std::string there =
            nearest.sun < 0
                ? std::string("which has no suns")
                : fmt::format(
                      "the nearest of whose {} suns, that of {}, is {:.4g} degrees away, more than "
                      "max_sun_deg = {:g}",
                      ground.day.suns.size(), sun_text(sun_at(ground.day, nearest.sun)), nearest.degrees,
                      light.shadow.max_sun_deg);
        refuse(i, fmt::format("light '{}' stands where no sun of '{}' does, {}", light.light.id, ground.name,
                              there));
    }
}

OtherCasters other_casters(const Mesh& mesh, std::uint32_t first, std::uint32_t count) {
    OtherCasters other;
    std::unordered_map<std::uint32_t, std::uint32_t> vertices, faces;
    other.mesh.objects = mesh.objects;
    other.mesh.components = mesh.components;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto whole = static_cast<std::uint32_t>(t);
        if (whole >= first && whole - first < count) continue;
        if (!mesh.objects.empty() && !mesh.objects[mesh.object[t]].casts_shadow) continue;
        Triangle corners = mesh.triangles[t];
        for (std::uint32_t& v : corners.v) {
            const auto [at, fresh] =
                vertices.try_emplace(v, static_cast<std::uint32_t>(other.mesh.positions.size()));
            if (fresh) other.mesh.positions.push_back(mesh.positions[v]);
            v = at->second;
        }
        const auto [face, fresh] =
            faces.try_emplace(mesh.face[t], static_cast<std::uint32_t>(other.mesh.faces.size()));
        if (fresh) other.mesh.faces.push_back(mesh.faces[mesh.face[t]]);
        other.mesh.triangles.push_back(corners);
        other.mesh.object.push_back(mesh.objects.empty() ? 0 : mesh.object[t]);
        other.mesh.material.push_back(0);
        other.mesh.component.push_back(mesh.component[t]);
        other.mesh.face.push_back(face->second);
        other.triangle.push_back(whole);
    }
    other.mesh.normals.resize(other.mesh.positions.size());
    return other;
}

bool make_day_shadow(const ShadowWork& work, const TreeNeeds*, std::int64_t, LightShadow& shadow) {
    const Stopwatch watch;
    const SceneDay& day = work.scene.days.at(shadow.light.light.id);
    const SceneTerrain& terrain = work.scene.terrains[day.terrain];
    const NearestSun nearest = nearest_sun(day.ground->day, -normalize(shadow.light.light.direction));
    if (nearest.sun < 0 || nearest.degrees > shadow.light.shadow.max_sun_deg) {
        check_days(work.scene, [](std::size_t, const std::string& why) { throw InputError("scene", why); });
    }
    shadow.day = day_sun(day.ground, nearest.sun, work.exec);
    shadow.stats.sun_text = sun_text(sun_at(day.ground->day, nearest.sun));
    shadow.stats.sun_off_deg = nearest.degrees;
    shadow.stats.bytes = static_cast<std::uint64_t>(
        day_sun_bytes(std::int64_t{terrain.field->width()} * terrain.field->height()));
    // What is not this ground casts by itself; its numbers are those of the whole mesh, which points know.
    const OtherCasters other = other_casters(work.scene.mesh, terrain.first_triangle, terrain.triangles);
    if (!other.triangle.empty()) {
        shadow.exact =
            build_casters(other.mesh, shadow.light.light, work.exec, work.cache.caster_scratch, work.cancel);
        if (shadow.exact.empty()) return false;
        for (Casters& view : shadow.exact) {
            for (std::size_t i = 0; i < view.count; ++i) {
                CasterTriangle& t = view.triangles[i];
                t.triangle = other.triangle[t.triangle];
                t.face = work.scene.mesh.face[t.triangle];
            }
            shadow.stats.casters += static_cast<std::int64_t>(view.count);
            shadow.stats.bytes += static_cast<std::uint64_t>(view.bytes());
        }
    }
    shadow.stats.build.build_s = watch.seconds();
    return true;
}

void give_day_shadow(const ShadowWork& work, const LightShadow& shadow, const TileScene& tiles,
                     TileLight& light) {
    const SceneDay& day = work.scene.days.at(shadow.light.light.id);
    light.day =
        day_light(*shadow.day, work.scene.terrains[day.terrain], shadow.light.light, work.scene.camera.eye);
    if (tiles.mesh != &work.scene.mesh) {
        light.day->object = tiles.mesh->object.data();
        light.day->own_object = work.scene.mesh.object[light.day->first_triangle];
    }
    if (!shadow.exact.empty())
        light.exact = exact_light(shadow.light.light, shadow.exact, *tiles.mesh, tiles.rays);
}

std::string day_shadow_text(const LightShadowStats& s) {
    return fmt::format(
        "a day's far shadows, sun of {}, {:.2g} degrees off, {}{}; {} beside the ground; decode {:.3f} s, "
        "lookups {:.3f} s (all threads)\n",
        s.sun_text, s.sun_off_deg, size_text(static_cast<std::int64_t>(s.bytes)), s.kept ? ", kept" : "",
        count_text(s.casters, "triangle"), s.build.build_s, s.lookup_s);
}

ShadowBytes day_shadow_bytes(const SceneLight&, const MeshSize& mesh, const RenderSettings&) {
    // Half a sample for each triangle of ground; all may be ground, and all may stand on it.
    const std::int64_t samples = mesh.triangles / 2;
    ShadowBytes bytes;
    bytes.kept = day_sun_bytes(samples) + casters_bytes(mesh.triangles);
    bytes.making = day_decoding_bytes(samples);
    bytes.setup = setup_bytes(mesh) + casters_sorting_bytes(mesh.triangles);
    return bytes;
}

std::string day_plan_text(const SceneLight& light, const std::optional<FoundResolution>&,
                          const Scene& scene) {
    const SceneDay& day = scene.days.at(light.light.id);
    const FarDay& far = day.ground->day;
    const SceneTerrain& terrain = scene.terrains[day.terrain];
    const std::size_t others = caster_count(scene.mesh) - terrain.triangles;
    std::string out = fmt::format(
        ", far shadows of {} suns over terrain '{}' from {}, {}; near ones by rays of up to {}; {} beside "
        "it, exact",
        far.suns.size(), terrain.id, day.ground->name, size_text(static_cast<std::int64_t>(far.bytes.size())),
        count_text(far.params.threshold, "line"), count_text(others, "triangle"));
    const NearestSun nearest = nearest_sun(far, -normalize(light.light.direction));
    if (!light.light.below_horizon && nearest.sun >= 0)
        out += fmt::format("; the sun of {}", sun_text(sun_at(far, nearest.sun)));
    return out;
}

}  // namespace obscura
