#include "raster/lighting.h"

#include <algorithm>

#include "core/emitter_surface.h"
#include "core/num.h"
#include "core/vec_arrays.h"

namespace obscura {

std::vector<ShadeMaterial> shade_materials(const std::vector<Material>& materials) {
    std::vector<ShadeMaterial> result;
    for (const Material& m : materials) {
        ShadeMaterial s{};
        set(s.base, m.base_color);
        set(s.emission, m.emission);
        const float roughness = std::clamp(m.roughness, 0.02f, 1.0f);
        s.alpha = roughness * roughness;
        s.alpha2 = s.alpha * s.alpha;
        s.gloss = 1.0f - roughness;
        // Half of a GGX lobe's mirror directions lie within about 2 alpha of its middle.
        s.sharpness = 0.25f / s.alpha;
        s.metallic = m.metallic;
        s.translucency = m.translucency;
        s.texture = m.texture;
        result.push_back(s);
    }
    // Samples that nothing covers name material 0.
    if (result.empty()) result.push_back(ShadeMaterial{});
    return result;
}

ShadeLight shade_light_of(const Light& light, Vec3d eye) {
    ShadeLight s;
    set(s.to_light, to_float(-normalize(light.direction)));
    set(s.color, light.color);
    if (!is_parallel(light.kind)) {
        s.kind = light.kind == LightKind::spot ? ShadeLightKind::spot : ShadeLightKind::point;
        set(s.position, to_float(light.position - eye));
        s.inv_range2 = static_cast<float>(1.0 / (light.range_m * light.range_m));
    }
    if (light.kind == LightKind::area) {
        s.kind = ShadeLightKind::patch;
        const double patch_m2 = area_m2(light) * light.part;
        set(s.color, light.color * static_cast<float>(patch_m2));
        s.radius2 = static_cast<float>(patch_m2 / num::pi);
        s.two_sided = light.two_sided ? 1.0f : 0.0f;
    }
    // Seen from its middle alone: a point that gives off as much. A surface's flux is pi L A, a point's 4 pi
    // I.
    if (light.kind == LightKind::surface && light.surface != nullptr)
        set(s.color, light.color * static_cast<float>(light.surface->area_m2 / 4));
    if (light.kind == LightKind::spot) {
        const double outer = num::cos_deg(light.outer_cone_deg), inner = num::cos_deg(light.inner_cone_deg);
        s.cos_outer = static_cast<float>(outer);
        // A cone without a soft edge: a very steep one.
        s.inv_cone = static_cast<float>(1.0 / std::max(inner - outer, 1e-6));
    }
    return s;
}

double area_m2(const Light& light) {
    return light.width_m * light.height_m * (light.shape == AreaShape::disc ? num::pi / 4 : 1.0);
}

bool sheds_light(const Light& light) {
    return !light.below_horizon && (light.color.x > 0 || light.color.y > 0 || light.color.z > 0);
}

ShadeSky shade_sky(const Sky& sky) {
    ShadeSky s{};
    set(s.zenith, sky.zenith);
    set(s.horizon, sky.horizon);
    set(s.ground, sky.ground);
    s.ambient = sky.ambient;
    s.diffuse = sky.occlusion ? 0.0f : 1.0f;
    s.background = sky.visible ? 1.0f : 0.0f;
    return s;
}

}  // namespace obscura
