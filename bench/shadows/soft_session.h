#pragma once
// Shadows of a light with a size as methods that are timed: all of its points for all samples of a frame.

#include <cstdint>
#include <span>
#include <vector>

#include "app/scene/scene.h"
#include "bench/harness/contestant.h"
#include "bench/shadows/frame_samples.h"

namespace obscura {

/// Lit samples of each point of a light: ExactPoints' masks, tile by tile.
using LitOfPoints = std::vector<std::vector<std::uint32_t>>;

/// Jobs "order": what casts shadows, put in order as the light's middle sees it, and of parallel light where
/// every point sees the vertices; and "lookups": the shadows of all samples from each of `points` points of
/// lights[0]. Points that are no disc's have casters of their own, whose order is of the lookups' time.
/// `scene` and `samples` outlive the session.
Session open_soft(const Scene& scene, const FrameSamples& samples, int points, const Exec& exec);

/// Wall-clock milliseconds of the two jobs of a session.
struct SoftTimes {
    double order_ms = 0, lookup_ms = 0;
};

/// What open_soft() looks up; of one run of each job, its time.
LitOfPoints soft_shadows(const Scene& scene, const FrameSamples& samples, int points, const Exec& exec,
                         SoftTimes* times = nullptr);

/// The scene with lights[0] as so many without size.
Scene with_points(const Scene& scene, int points);

}  // namespace obscura
