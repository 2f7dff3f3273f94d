// What depends on the frame.

#include <algorithm>
#include <vector>

#include "app/scene/build.h"
#include "app/scene/keyframes.h"

#include "app/scene/keys.h"
#include "app/scene/validate.h"
#include "core/num.h"
#include "core/sky/clear_sky.h"

namespace obscura {
namespace {

/// The light that a sky follows, of the scene's: the named one, or the first sun, or parallel light. May be
/// the end.
std::vector<SceneLight>::iterator sun_of(Scene& scene) {
    const auto first = [&](auto&& is) { return std::find_if(scene.lights.begin(), scene.lights.end(), is); };
    const std::string& id = scene.sky.sun;
    if (!id.empty()) return first([&](const SceneLight& l) { return l.light.id == id; });
    const auto sun = first([](const SceneLight& l) { return l.light.kind == LightKind::sun; });
    return sun != scene.lights.end() ? sun
                                     : first([](const SceneLight& l) { return is_parallel(l.light.kind); });
}

/// What a sky takes from its sun, and what its sun takes from the sky.
void set_sky(Scene& scene, const SceneDocument& document, double frame) {
    Sky& sky = scene.sky;
    if (sky.kind != SkyKind::clear && sky.kind != SkyKind::overcast) return;
    const auto sun = sun_of(scene);
    if (sun == scene.lights.end()) return;
    const Vec3d to = -normalize(sun->light.direction);
    sky.sun_elevation_deg = num::asin(std::clamp(to.y, -1.0, 1.0)) * (180 / num::pi);
    sky.sun_azimuth_deg = num::atan2(to.x, -to.z) * (180 / num::pi);
    const SceneTable& table =
        *subtables(document.root, "light")[static_cast<std::size_t>(sun - scene.lights.begin())];
    if (sun->light.kind != LightKind::sun || table.has("irradiance_w_m2")) return;
    const double above = number(light_at(document, table, frame), "extraterrestrial_w_m2");
    sky.sun_above_air = {above, above, above};
    if (sky.kind == SkyKind::overcast) {
        sun->light.color = {0, 0, 0};
    } else if (!sun->light.below_horizon) {
        constexpr int wavelengths = 10;
        sun->light.color = sun_irradiance(air_spectrum(sky.turbidity, sky.sun_above_air, wavelengths),
                                          sky.sun_elevation_deg);
    }
}

/// What a light of surfaces shines from, and how brightly.
void set_surface(const Scene& scene, Light& light) {
    const auto emitter = scene.emitters.find(light.material);
    if (emitter == scene.emitters.end()) return;
    const EmitterSurface& surface = *emitter->second;
    light.surface = emitter->second;
    light.position = surface.middle;
    const auto material = std::find_if(scene.materials.begin(), scene.materials.end(),
                                       [&](const Material& m) { return m.name == light.material; });
    light.color = surface.pieces.empty() ? Vec3f{0, 0, 0} : material->emission;
}

}  // namespace

void set_frame(Scene& scene, const SceneDocument& document, double frame) {
    scene.camera = camera_of(camera_at(document, frame));
    Image<float> mask = std::move(scene.optics.mask);
    scene.optics = optics_of(document, frame);
    scene.optics.mask = std::move(mask);
    scene.lights.clear();
    for (const SceneTable* light : subtables(document.root, "light")) {
        scene.lights.push_back(light_of(light_at(document, *light, frame)));
    }
    for (SceneLight& light : scene.lights) {
        if (light.light.kind == LightKind::surface) set_surface(scene, light.light);
    }
    set_sky(scene, document, frame);
}

}  // namespace obscura
