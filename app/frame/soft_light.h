#pragma once
// Lights with a size: many without, a few at a time. Pass after pass over the tiles adds what some of them
// shed, and their casters are dropped, so that memory is that of a few however many there are.

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "app/frame/frame.h"
#include "app/scene/scene.h"
#include "core/isa.h"
#include "core/mesh_memory.h"
#include "raster/exact/exact_soft.h"
#include "raster/shade.h"

namespace obscura {

struct TileScene;
struct LightShadow;

/// A light with a size, of a picture. Each pixel asks all of its points: sample s of it every m-th from s % m
/// on, m a share of its samples.
struct SoftLight {
    std::size_t scene_light = 0;  ///< index into Scene::lights
    std::size_t shadow = 0;       ///< and among those with shadows
    Light whole;
    std::vector<Light> points;           ///< light_samples() of it
    std::vector<double> solid_angle_sr;  ///< of the sky's
    bool is_sky = false;  ///< they are the sky's (FrameSky::lights), not one light's, and count in no AOV
    std::optional<ExactLight> middle;  ///< parallel light: for all points at once
};

/// Which of a picture's samples a pass is of, and what all of its lights have in common.
struct SoftPass {
    const SoftLight* light = nullptr;
    const ExactSoft* soft = nullptr;  ///< parallel light: how its shadows are found, for all of the lights
    int first = 0, stride = 1;        ///< samples of the pattern
    std::vector<ShadeSkyPart> sky;    ///< the sky: all parts that the samples ask, in whatever pass
    float shadow_lights = 1;          ///< a pass's light is one of so many in Frame::shadow
};

/// Whether the light's shadows have penumbrae; of its points there may still be one.
bool is_soft(const SceneLight& light);

/// How many of a light's points pixels ask, by its settings or by the widest penumbra: 1, or a power of four.
int points_for_penumbra(const SceneLight& light, float widest_px);

/// Width in pixels of the widest penumbra of a light, whose middle's casters `shadow` holds, in the pictures.
float widest_penumbra(std::span<const TileScene> pictures, const LightShadow& shadow, const Exec& exec);

constexpr int most_soft_together = 64;

/// Points of a light that one pass asks, most_soft_together at most, and the bytes of what it then holds.
/// `disc`: of parallel light with a size; else each point has casters of its own.
int soft_points_together(const MeshSize& mesh, bool disc);
std::int64_t soft_pass_bytes(const MeshSize& mesh, bool disc);

/// How many passes the soft lights of the tiles take.
int soft_passes(const TileScene& tiles);

/// Calls visit() with each pass over the tiles, in order. False when cancelled.
bool walk_soft_passes(const TileScene& tiles, const Exec& exec, const std::atomic<bool>* cancel,
                      std::span<LightShadowStats> stats,
                      const std::function<bool(const TileScene& pass)>& visit);

/// Adds to frame.radiance, and to frame.shadow where that is wanted, what the soft lights of the tiles shed.
/// options.progress is told of each pass as a share of all.
void add_soft_lights(const TileScene& tiles, const FrameOptions& options, const Exec& exec, Frame& frame);

}  // namespace obscura
