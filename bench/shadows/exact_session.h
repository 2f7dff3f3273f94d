#pragma once
// Exact shadows of a frame as a method that is timed, and Embree's rays for the same samples.

#include <cstdint>
#include <span>
#include <vector>

#include "app/scene/scene.h"
#include "bench/harness/contestant.h"
#include "bench/shadows/frame_samples.h"

namespace obscura {

/// What the second job of either session delivers: counts as two floats each, of 24 bits.
struct ExactFindings {
    std::int64_t asked = 0, lit = 0;         ///< pairs of sample and light that something may darken; lit
    std::int64_t groups = 0, triangles = 0;  ///< as ExactCounts
};
inline constexpr std::size_t findings_floats = 8;
void write_findings(const ExactFindings& findings, float* to);
ExactFindings read_findings(const float* from);

/// The samples that each light's exact shadows look up, as ExactPoints' masks, tile by tile.
std::vector<std::vector<std::uint32_t>> asked_samples(const FrameSamples& samples,
                                                      std::span<const ExactLight> lights, const Exec& exec);

/// Jobs "order": build_casters() of every light with shadows; and "lookups": the shadows of all samples.
/// `scene` and `samples` outlive the session.
Session open_exact(const Scene& scene, const FrameSamples& samples, const Exec& exec);

/// Jobs "hierarchy": Embree's, of all triangles that cast shadows; and "packets of 16 rays": coherent, for
/// exactly the pairs of sample and light that open_exact() looks up. They are of 4 x 4 pixels, or 2 x 2 with
/// four samples each. Rays start off the surface by what exact shadows call uncertain of the sample, and 8
/// units in the last place of the largest coordinate. Only with Embree.
Session open_exact_rays(const Scene& scene, const FrameSamples& samples, const Exec& exec);

/// Of each light with shadows, the samples that ask and those that light reaches, as ExactPoints' masks.
struct TracedSamples {
    std::vector<std::vector<std::uint32_t>> asked, lit;
    double hierarchy_ms = 0, trace_ms = 0;  ///< wall clock, of one run
};
/// What those rays find. Only with Embree.
TracedSamples trace_samples(const Scene& scene, const FrameSamples& samples, const Exec& exec);

}  // namespace obscura
