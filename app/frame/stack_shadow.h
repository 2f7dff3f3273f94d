#pragma once
// method = "stack": the shadows of a light with a size from one octree of the maps of all its points
// (hierarchy/stack). Planned from the scene, built once, kept while light and scene stay.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/frame/shadow_method.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "hierarchy/codes/tree_file.h"
#include "hierarchy/stack/focus.h"

namespace obscura {

/// light_samples() of a light, the same that `exact` asks, put in the order of a Hilbert curve: map k of its
/// stack is that of point k.
std::vector<Light> stack_points(const SceneLight& light);

/// What a light's stack is made of.
struct StackPlan {
    std::vector<Light> points;  ///< stack_points()
    LightSamples samples;
    FocusParams focus;  ///< its resolution the light's, or the least when that is still to be found
};

/// Aims the light's points at a plane of the scene: level, or facing the light, through the median of what
/// faces that side below it; of the two the one that things are nearer to, along the light's way, since what
/// lies in it stays where it is in all maps. Throws InputError when there is none: where more than an eighth
/// of what the light may shine on lies beside or behind it, or too near, its maps do not see it.
StackPlan plan_stack(const Mesh& mesh, const SceneLight& light);

/// Plans the stack of every light that has one. `refuse(index of the light, why)` is called, and throws,
/// where a light has no plane.
void check_stack_plans(const Scene& scene,
                       const std::function<void(std::size_t light, const std::string& why)>& refuse);

/// The views of a plan at this resolution.
FocusedViews stack_views(const Mesh& mesh, const StackPlan& plan, int resolution);

/// Lights that the points of each of `parts` equal runs of the plan shine as: from their middle, all of their
/// light.
std::vector<Light> stack_parts(const std::vector<Light>& points, std::size_t parts);

/// Builds shadow.stack for shadow.light (its resolution a number) and counts it. `most_bytes`: what nodes may
/// take while it is made; construction stops with LimitError before they take more. False when `cancel` was
/// set meanwhile.
bool build_light_stack(const Mesh& mesh, const FocusedViews& views, const Exec& exec, std::int64_t most_bytes,
                       LightShadow& shadow, const std::atomic<bool>* cancel);

/// Reads shadow.stack from the file of an earlier run, or leaves it empty. Returns why a file that is there
/// could not be used, empty otherwise.
std::string read_light_stack(const std::filesystem::path& file, const TreeFileKey& key,
                             const FocusedViews& views, LightShadow& shadow);

// Of ShadowMethodRow; the stack is read from its file, or built and written there.
ResolutionQuery stack_resolution(const Scene& scene, const SceneLight& light);
bool make_stack_shadow(const ShadowWork& work, const TreeNeeds* needs, std::int64_t most_bytes,
                       LightShadow& shadow);
void give_stack_shadow(const ShadowWork& work, const LightShadow& shadow, const TileScene& tiles,
                       TileLight& light);
std::string stack_shadow_text(const LightShadowStats& stats);
ShadowBytes stack_shadow_bytes(const SceneLight& light, const MeshSize& mesh, const RenderSettings& render);
std::string stack_plan_text(const SceneLight& light, const std::optional<FoundResolution>& found,
                            const Scene& scene);

/// Expected bytes of a finished stack, and of what making it holds beside that, with so many triangles that
/// cast shadows. While its resolution is to be found, of the finest there may be.
std::int64_t stack_bytes(const SceneLight& light, std::int64_t triangles);
std::int64_t stack_work_bytes(const SceneLight& light, std::int64_t triangles);

}  // namespace obscura
