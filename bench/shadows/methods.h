#pragma once
// The shadow maps that are compared: dense, and compressed.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/shadows/scenes.h"
#include "bench/shadows/wrong_pixels.h"
#include "filters/pcf.h"
#include "hierarchy/codes/query.h"

namespace obscura {

/// One way to look a block's samples up.
struct ShadowLookup {
    std::string name;  ///< "1 tap", "3x3", ...
    BlockLookup block;
};

/// One way to look up points whose place on the map is known already.
struct PointLookup {
    std::string name;  ///< "points", ...
    std::function<void(const MapPoints& points, std::uint16_t* lit)> look;
};

/// A map of lights[0], ready for lookups.
struct BuiltShadow {
    LightView view;
    std::int64_t bytes = 0;
    double build_s = 0;
    /// The ways it can be asked, "1 tap" first; they keep the map alive.
    std::function<std::vector<ShadowLookup>(Isa isa)> lookups;
    std::function<std::vector<PointLookup>(Isa isa)> point_lookups;
    PcfLight light;  ///< where lookups fall on the map, for map_points()
};

/// One float per texel; size up to 16384.
BuiltShadow build_dense(const Scene& scene, int size, const Exec& exec);

/// The tree of a map of up to 2^20 texels a side, with the top grid that scenes have by default, which
/// `bytes` count. `scene` must outlive the result.
BuiltShadow build_compressed(const Scene& scene, int size, const Exec& exec);

}  // namespace obscura
