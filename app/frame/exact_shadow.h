#pragma once
// method = "exact": what casts, in order, for shadows of the picture's own samples (raster/exact).

#include "app/frame/shadow_method.h"

namespace obscura {

// Of ShadowMethodRow.
bool make_exact_shadow(const ShadowWork& work, const TreeNeeds* needs, std::int64_t most_bytes,
                       LightShadow& shadow);
void give_exact_shadow(const ShadowWork& work, const LightShadow& shadow, const TileScene& tiles,
                       TileLight& light);
std::string exact_shadow_text(const LightShadowStats& stats);
ShadowBytes exact_shadow_bytes(const SceneLight& light, const MeshSize& mesh, const RenderSettings& render);
std::string exact_plan_text(const SceneLight& light, const std::optional<FoundResolution>& found,
                            const Scene& scene);

}  // namespace obscura
