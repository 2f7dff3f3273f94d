#pragma once
// method = "day": shadows of ground from the far bits of a day's file and short rays (hierarchy/terrain), and
// exact ones (raster/exact) of all that is not that ground. Light must pass both.

#include <cstdint>
#include <functional>
#include <string>

#include "app/frame/shadow_method.h"
#include "core/mesh.h"
#include "hierarchy/terrain/day_shadow.h"

namespace obscura {

/// Whether the light of every `day` stands where a sun of its file does. `refuse(index of the light, why)` is
/// called, and throws, where it stands further off than max_sun_deg.
void check_days(const Scene& scene,
                const std::function<void(std::size_t light, const std::string& why)>& refuse);

/// The casters of `mesh` but for triangles [first, first + count), with the numbers that they have in it.
struct OtherCasters {
    Mesh mesh;
    std::vector<std::uint32_t> triangle;  ///< of each of its triangles, in the whole mesh
};
OtherCasters other_casters(const Mesh& mesh, std::uint32_t first, std::uint32_t count);

// Of ShadowMethodRow.
bool make_day_shadow(const ShadowWork& work, const TreeNeeds* needs, std::int64_t most_bytes,
                     LightShadow& shadow);
void give_day_shadow(const ShadowWork& work, const LightShadow& shadow, const TileScene& tiles,
                     TileLight& light);
std::string day_shadow_text(const LightShadowStats& stats);
ShadowBytes day_shadow_bytes(const SceneLight& light, const MeshSize& mesh, const RenderSettings& render);
std::string day_plan_text(const SceneLight& light, const std::optional<FoundResolution>& found,
                          const Scene& scene);

}  // namespace obscura
