#pragma once
// Shadows in words, for `render -v` and `check`.

#include <span>
#include <string>

#include "app/frame/light_shadow_stats.h"
#include "app/scene/scene.h"
#include "raster/view.h"

namespace obscura {

/// "10.0 KiB".
std::string size_text(std::int64_t bytes);

/// "auto: 8192 x 8192, a texel spans at most 0.83 pixels, at (12, 480)".
std::string resolution_text(const FoundResolution& found);

/// Whether the note below is owed: a bound that the file gives is not kept, or pixels see the texels.
bool tells_cap(const SceneLight& light, const FoundResolution& found);
/// The note on a light whose resolution is the largest there is and still too coarse for the picture.
std::string capped_text(const SceneLight& light, const FoundResolution& found);

/// What would make a tree of these settings smaller: the advice of the error when memory does not suffice.
std::string smaller_tree_text(const ShadowSettings& shadow);

/// "6 maps of 1024 x 1024 (auto: ...), EXTENT, 24.0 MiB, kept"; `extent`: from the comma on.
std::string maps_text(const LightShadowStats& stats, const std::string& extent = "");

/// ", 6 dense shadow maps of 1024 x 1024, texels of 34 mm, filter 3 x 3"; `views`: of the maps, or none.
std::string maps_plan_text(const SceneLight& light, const char* kind, std::span<const LightView> views);

/// Triangles that cast shadows.
std::size_t caster_count(const Mesh& mesh);
/// Samples of the scene's picture with its margin, as planned: "8294400 samples".
std::string picture_samples_text(const Scene& scene);

/// What `render -v` tells of one light: some indented lines.
std::string shadow_text(const LightShadowStats& stats);

}  // namespace obscura
