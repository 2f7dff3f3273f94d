#pragma once
// The exact shadows of every sample under one sun, in one pass over the samples.

#include <cstdint>
#include <span>
#include <vector>

#include "core/isa.h"
#include "raster/heights/height_field.h"
#include "raster/heights/height_sun.h"
#include "raster/heights/shadow_bits.h"

namespace obscura {

struct SweepStats {
    std::int64_t samples = 0;  ///< times thresholds
    std::int64_t marched = 0;  ///< of these, too close to a tie for doubles: decided by sun_hidden()
};

/// A map for each threshold d >= 0: the samples that ground from the d-th line beyond their own on hides from
/// the sun. 0 gives whole shadows, the others the far shadows of Chajdas, Reichl, Dick, Westermann,
/// "High-Quality Shadows for Streaming Terrain Rendering" (Eurographics 2014, short papers), section 3.1:
/// casters nearer than d lines do not count. Every bit is that of march_shadows(), {d, all}. On ground
/// time is near O(samples) and memory near a line of samples beside the result. That is no bound: a profile
/// keeps each line that some sample still sees, and ground that is made for it keeps up to all samples', in
/// memory and in the time of every merge.
std::vector<ShadowBits> sweep_shadows(const HeightField& field, const HeightSun& sun,
                                      std::span<const int> thresholds, SweepStats* stats = nullptr);

/// The same for many suns at once, a thread each: result[sun][threshold].
std::vector<std::vector<ShadowBits>> sweep_suns(const HeightField& field, std::span<const HeightSun> suns,
                                                std::span<const int> thresholds, const Exec& exec);

}  // namespace obscura
