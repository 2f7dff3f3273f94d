#pragma once
// The ways to make a light's shadows, a row each. What a row points to stands with its method: dense_shadow,
// tree_shadow, exact_shadow, stack_shadow, day_shadow.

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/frame/frame.h"
#include "app/frame/light_shadow.h"
#include "app/frame/render_frame.h"
#include "app/frame/shadow_resolution.h"
#include "app/frame/tile.h"
#include "core/mesh_memory.h"
#include "hierarchy/needed_nodes.h"

namespace obscura {

/// What making the shadows of a frame shares.
struct ShadowWork {
    const Scene& scene;
    std::int64_t most_bytes;  ///< for all shadows together
    const Exec& exec;
    FrameCache& cache;
    std::span<TileScene> pictures;
    FrameStats& stats;
    const FrameOptions& options;  ///< of the frame
    const std::atomic<bool>* cancel;
};

/// What the pictures look up of each of a light's views; none: so much that all of it is built.
using TreeNeeds = std::optional<std::vector<NeededNodes>>;

/// What a light's shadow takes, expected, in bytes.
struct ShadowBytes {
    std::int64_t kept = 0;    ///< while frames are rendered
    std::int64_t lists = 0;   ///< until the shadows of all lights are made
    std::int64_t making = 0;  ///< meanwhile, one light after another
    std::int64_t setup = 0;   ///< kept with the frame for the next, by all lights of the method together
};

struct ShadowMethodRow {
    ShadowMethod method;
    bool maps_middle;   ///< maps of a light's middle alone: shadows of lights with a size are hard
    bool whole_blocks;  ///< `kept` lies in blocks that leave the allocator nothing over
    bool uses_layers;   ///< maps are made from the layers of tiles, one in every thread
    ShadowBytes (*bytes)(const SceneLight& light, const MeshSize& mesh, const RenderSettings& render);
    /// What `check` tells of it before it is made, from behind the light's kind to before the end of the
    /// line.
    std::string (*plan)(const SceneLight& light, const std::optional<FoundResolution>& found,
                        const Scene& scene);
    /// Finds what resolution = "auto" is; null: there is none to find.
    ResolutionQuery (*query)(const Scene& scene, const SceneLight& light);
    /// Makes shadow.light's shadow, or reads it from its file, and counts it. `needs`: of a tree that is
    /// built for the pictures, else null. `most_bytes`: what it may take; LimitError before it takes more.
    /// False when cancelled meanwhile.
    bool (*make)(const ShadowWork& work, const TreeNeeds* needs, std::int64_t most_bytes,
                 LightShadow& shadow);
    /// Lets a picture's light ask it.
    void (*give)(const ShadowWork& work, const LightShadow& shadow, const TileScene& tiles, TileLight& light);
    /// What -v tells of it, from behind the light's name to the end of the line.
    std::string (*text)(const LightShadowStats& stats);
};

/// Of every method but `none`.
const ShadowMethodRow& row_of(ShadowMethod method);

std::span<const ShadowMethodRow> shadow_methods();

/// Whether the picture is to say how fine the light's map is.
bool wants_auto(const SceneLight& light);

/// Extent of what casts along the axes of parallel light, nothing of other lights.
Bounds casters_of(const Scene& scene, const Light& light);

}  // namespace obscura
