#pragma once
// method = "map": a dense shadow map, or six.

#include "app/frame/shadow_method.h"

namespace obscura {

// Of ShadowMethodRow.
bool make_dense_shadow(const ShadowWork& work, const TreeNeeds* needs, std::int64_t most_bytes,
                       LightShadow& shadow);
void give_dense_shadow(const ShadowWork& work, const LightShadow& shadow, const TileScene& tiles,
                       TileLight& light);
std::string dense_shadow_text(const LightShadowStats& stats);
ShadowBytes dense_shadow_bytes(const SceneLight& light, const MeshSize& mesh, const RenderSettings& render);
std::string dense_plan_text(const SceneLight& light, const std::optional<FoundResolution>& found,
                            const Scene& scene);

}  // namespace obscura
