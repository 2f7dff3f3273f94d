#include "app/scene/enclosed_lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/num.h"
#include "core/topology.h"

namespace obscura {
namespace {

/// Of what is closed and casts shadows.
struct Solid {
    std::uint32_t object = 0;
    bool casts = false;
    Vec3d lo{HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    double volume = 0;

    bool has_in_box(Vec3d p) const {
        return casts && p.x > lo.x && p.y > lo.y && p.z > lo.z && p.x < hi.x && p.y < hi.y && p.z < hi.z;
    }
};

/// One per component.
std::vector<Solid> solids_of(const Mesh& mesh) {
    std::vector<Solid> solids(mesh.components.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Solid& solid = solids[mesh.component[t]];
        solid.object = mesh.object[t];
        solid.casts = mesh.components[mesh.component[t]].closed && mesh.objects[solid.object].casts_shadow;
        for (const std::uint32_t v : mesh.triangles[t].v) {
            const Vec3d p = to_double(mesh.positions[v]);
            solid.lo = {std::min(solid.lo.x, p.x), std::min(solid.lo.y, p.y), std::min(solid.lo.z, p.z)};
            solid.hi = {std::max(solid.hi.x, p.x), std::max(solid.hi.y, p.y), std::max(solid.hi.z, p.z)};
        }
    }
    const std::vector<double> volumes = signed_volumes(mesh);
    for (std::size_t c = 0; c < solids.size(); ++c)
        solids[c].volume = volumes[c];
    return solids;
}

/// In steradians, seen from the origin; positive where it is clockwise, as an outside is from within.
double solid_angle(Vec3d a, Vec3d b, Vec3d c) {
    const double la = length(a), lb = length(b), lc = length(c);
    return 2 *
           num::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

/// The object that holds p, or no_object.
constexpr std::uint32_t no_object = std::numeric_limits<std::uint32_t>::max();
std::uint32_t object_around(const Mesh& mesh, const std::vector<Solid>& solids,
                            const std::vector<bool>& left_out, Vec3d p) {
    std::vector<double> turns(mesh.objects.size()), volume(mesh.objects.size());
    bool any = false;
    for (const Solid& solid : solids) {
        if (!solid.has_in_box(p) || left_out[solid.object]) continue;
        any = true;
        volume[solid.object] += solid.volume;
    }
    if (!any) return no_object;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Solid& solid = solids[mesh.component[t]];
        if (!solid.has_in_box(p)) continue;
        const auto corner = [&](int k) { return to_double(mesh.positions[mesh.triangles[t].v[k]]) - p; };
        turns[solid.object] += solid_angle(corner(0), corner(1), corner(2)) / (4 * num::pi);
    }
    std::uint32_t inner = no_object;
    for (std::uint32_t o = 0; o < turns.size(); ++o) {
        // On a wall it is a half.
        if (turns[o] > 0.75 && !left_out[o] && (inner == no_object || volume[o] < volume[inner])) inner = o;
    }
    return inner;
}

/// For every object whether it shines as this light does: what stands in itself is in nothing.
std::vector<bool> own_objects(const Scene& scene, const Light& light) {
    std::vector<bool> own(scene.mesh.objects.size());
    if (light.kind != LightKind::surface) return own;
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
        if (scene.materials[scene.mesh.material[t]].name == light.material) own[scene.mesh.object[t]] = true;
    }
    return own;
}

}  // namespace

std::vector<std::string> enclosed_lamp_notes(const Scene& scene) {
    std::vector<std::string> notes;
    std::vector<Solid> solids;
    for (const SceneLight& light : scene.lights) {
        if (is_parallel(light.light.kind) || light.shadow.method == ShadowMethod::none) continue;
        if (solids.empty()) solids = solids_of(scene.mesh);
        const std::uint32_t object =
            object_around(scene.mesh, solids, own_objects(scene, light.light), light.light.position);
        if (object == no_object) continue;
        notes.push_back(fmt::format(
            "light '{}' is inside the solid '{}' and lights nothing outside of it; casts_shadow = false of "
            "that mesh lets light through",
            light.light.id, scene.mesh.objects[object].name));
    }
    return notes;
}

}  // namespace obscura
