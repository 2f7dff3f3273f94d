#pragma once
// The steps of raster and filters for a light of a scene, whose shadow settings say how.

#include <atomic>
#include <span>
#include <vector>

#include "app/scene/scene.h"
#include "filters/shadow_lookup.h"
#include "hierarchy/shadow_tree.h"
#include "raster/shadow_map.h"

namespace obscura {

/// shadow_views() of raster/shadow_map.h, with the light's own resolution.
std::vector<LightView> shadow_views(const SceneLight& light, const Bounds& bounds);

/// fitted_shadow_views(), with a resolution found for it.
std::vector<LightView> fitted_shadow_views(const SceneLight& light, const Bounds& casters, int resolution);

/// build_shadow_map() of the light's shadow_views().
bool build_shadow_map(const Mesh& mesh, const SceneLight& light, const Bounds& bounds, const Exec& exec,
                      RasterScratch& scratch, ShadowMap& map, const std::atomic<bool>* cancel = nullptr);

// pcf_light() of filters/shadow_lookup.h.
PcfLight pcf_light(const SceneLight& light, std::span<const LightView> views, Vec3d eye);
PcfLight pcf_light(const SceneLight& light, const ShadowMap& map, Vec3d eye);
PcfLight pcf_light(const SceneLight& light, std::span<const ShadowTree> trees, Vec3d eye);

}  // namespace obscura
