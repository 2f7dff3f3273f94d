#pragma once
// Whether the ground hides the sun from one sample, by walking along the ray: the definition, and the oracle
// of height_sweep.h.

#include <climits>

#include "raster/heights/height_sun.h"
#include "raster/heights/shadow_bits.h"
#include "raster/heights/sun_view.h"

namespace obscura {

/// Which part of a ray is asked: from the `first` line beyond the sample's own to the `last`, both included.
/// {0, all} is the whole ray, {d, all} what far maps of threshold d hold, {0, d} what a near ray adds to
/// them.
struct RayLines {
    int first = 0, last = INT_MAX;
};

/// True when the surface stands strictly above the ray from sample (line, row) to the sun somewhere over
/// these lines or between two of them. Exact: integers of at most 2^90.
bool sun_hidden(const SunView& view, int line, int row, RayLines lines = {}) noexcept;

/// The same for every sample.
ShadowBits march_shadows(const HeightField& field, const HeightSun& sun, RayLines lines = {});

}  // namespace obscura
