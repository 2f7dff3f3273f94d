#include "app/frame/scene_light.h"

namespace obscura {
namespace {

PcfParams pcf_params(const ShadowSettings& shadow) {
    return {shadow.filter_px, shadow.normal_offset_texels};
}

}  // namespace

std::vector<LightView> shadow_views(const SceneLight& light, const Bounds& bounds) {
    return shadow_views(light.light, {light.shadow.resolution, light.shadow.filter_px}, bounds);
}

std::vector<LightView> fitted_shadow_views(const SceneLight& light, const Bounds& casters, int resolution) {
    return fitted_shadow_views(light.light, {resolution, light.shadow.filter_px}, casters);
}

bool build_shadow_map(const Mesh& mesh, const SceneLight& light, const Bounds& bounds, const Exec& exec,
                      RasterScratch& scratch, ShadowMap& map, const std::atomic<bool>* cancel) {
    return build_shadow_map(mesh, shadow_views(light, bounds), light.shadow.receivers, exec, scratch, map,
                            cancel);
}

PcfLight pcf_light(const SceneLight& light, std::span<const LightView> views, Vec3d eye) {
    return pcf_light(light.light, pcf_params(light.shadow), views, eye);
}

PcfLight pcf_light(const SceneLight& light, const ShadowMap& map, Vec3d eye) {
    return pcf_light(light.light, pcf_params(light.shadow), map, eye);
}

PcfLight pcf_light(const SceneLight& light, std::span<const ShadowTree> trees, Vec3d eye) {
    return pcf_light(light.light, pcf_params(light.shadow), trees, eye);
}

}  // namespace obscura
