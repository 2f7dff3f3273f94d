#pragma once
// A town of closed solids, from a thousand triangles to a million: streets with kerbs, perimeter blocks,
// squares with trees, a few towers.

#include <cstdint>

#include "scenes/build.h"

namespace obscura {

struct CityParams {
    std::int64_t triangles = 100'000;  ///< wanted, 1000 .. 1,000,000; the result is within 5 % of it
    double extent_m = 0;  ///< side of the square it covers, 60 .. 4000; 0 = chosen to suit the triangles
    int seed = 1;
};

/// The town about the origin, streets level with y = 0, on a slab one metre thick. The triangles go where
/// they show: everybody gets a body and a roof first, then cornices and chimneys, then windows with reveals,
/// sills, bands, glazing bars, balconies; what is left over is spent on paving the streets with setts.
GeneratedModel city(const CityParams& params);

}  // namespace obscura
