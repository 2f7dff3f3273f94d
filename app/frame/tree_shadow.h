#pragma once
// method = "compressed": a tree of each of the light's views (hierarchy), whole or what a frame looks up,
// kept in a file where the scene says so.

#include "app/frame/shadow_method.h"

namespace obscura {

// Of ShadowMethodRow.
ResolutionQuery tree_resolution(const Scene& scene, const SceneLight& light);
bool make_tree_shadow(const ShadowWork& work, const TreeNeeds* needs, std::int64_t most_bytes,
                      LightShadow& shadow);
void give_tree_shadow(const ShadowWork& work, const LightShadow& shadow, const TileScene& tiles,
                      TileLight& light);
std::string tree_shadow_text(const LightShadowStats& stats);
ShadowBytes tree_shadow_bytes(const SceneLight& light, const MeshSize& mesh, const RenderSettings& render);
std::string tree_plan_text(const SceneLight& light, const std::optional<FoundResolution>& found,
                           const Scene& scene);

/// Squares (8 x 8 texels, or coarser ones) that a picture's lookups read of one light, expected: 1.2, 3 and
/// 8 per pixel at 1, 4 and 16 samples, which share more of them the closer they lie. No more than the map
/// has, nor than a collection may hold.
std::int64_t expected_squares(const ShadowSettings& shadow, std::int64_t maps, const RenderSettings& render);

/// The note that is owed where casters are open and receivers any: empty, or that trees may be large.
std::string open_casters_note(const SceneLight& light, const Scene& scene);

/// What the pictures look up of the trees that are to be built for them alone: one entry for each such shadow
/// that is not kept, in their order.
std::vector<TreeNeeds> tree_needs(const ShadowWork& work);

/// Builds and serialises the trees of shadow.light (its resolution a number), of which `needed` says what of
/// each view is wanted (null: everything). Fills shadow.trees and its statistics. `most_bytes`: what trees
/// may take while they are made; construction stops with LimitError before it takes more. False when `cancel`
/// was set meanwhile: there are then no trees.
bool build_light_trees(const Mesh& mesh, const std::vector<NeededNodes>* needed, const Exec& exec,
                       std::int64_t most_bytes, LightShadow& shadow, const std::atomic<bool>* cancel);

}  // namespace obscura
