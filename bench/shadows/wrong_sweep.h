#pragma once
// Shadows of a scene, as frames make them, against exact rays at every pixel: exact ones and the default
// tree. Built only with Embree.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/frame/light_shadow_stats.h"
#include "app/scene/shadow_settings.h"
#include "bench/harness/options.h"
#include "bench/shadows/results.h"
#include "bench/shadows/scenes.h"
#include "bench/shadows/shadow_bench.h"
#include "bench/shadows/visible_points.h"
#include "bench/shadows/wrong_pixels.h"
#include "core/parallel.h"

namespace obscura {

/// A staged scene, the points its pixels see, and what is so at them.
struct SweepStage {
    Exec exec{best_isa(), hardware_threads()};
    Scene scene;
    VisiblePoints points;
    ExactRays rays;
    TrueShadows truth;

    SweepStage(const ShadowRecipe& recipe, const PictureSize& picture);
};

/// What a shadow with these settings shows. `bytes`: of its trees, map or
/// casters.
struct SweepResult {
    std::optional<FoundResolution> found;
    std::uint64_t bytes = 0;
    double build_s = 0;   ///< the whole of prepare_shadows()
    double lookup_s = 0;  ///< of all pixels, the faster of two times; trees and maps
    WrongPixels wrong;
};

/// Makes the shadow of lights[0] as a frame of the scene does and looks it up at every point.
SweepResult sweep_shadow(SweepStage& stage, const ShadowSettings& settings);

/// Method exact, then trees with one tap per pixel at "auto" (a texel spans 1, 1/4, 1/16 pixel at most, or
/// frame_magnification) and at 1,048,576 texels a side; suns at 40, 8 and 1 degrees.
std::vector<SweepRow> measure_sweep(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                    const BenchOptions& options);

}  // namespace obscura
