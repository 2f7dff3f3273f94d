#pragma once
// The plan of a town: what stands where, before anything is built.

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace obscura {

enum class CityItemKind { house, slab, tower, tree, lamp };

/// One thing that can be built in several levels of detail. Its footprint is width_m x depth_m about (x, z);
/// its street front faces +Z before it is turned.
struct CityItem {
    CityItemKind kind = CityItemKind::house;
    double x = 0, z = 0, y = 0;
    double width_m = 10, depth_m = 8;
    int turns = 0;          ///< quarter turns about +Y
    bool detached = false;  ///< side walls are seen, too
    std::uint64_t seed = 0;
};

struct CityRect {
    double x0 = 0, x1 = 0, z0 = 0, z1 = 0;
};

struct CityBlock {
    CityRect area;        ///< up to the kerb
    CityRect heart;       ///< court or lawn inside the buildings; empty (x1 <= x0) when there is none
    bool square = false;  ///< a public square instead of buildings
};

struct CityPlan {
    double extent_m = 0;
    std::vector<CityBlock> blocks;
    std::vector<CityItem> items;
};

/// Streets, blocks and lots. `scale` stretches blocks and lots (1: lots of about 14 m); the streets keep
/// theirs.
CityPlan plan_city(double extent_m, double scale, std::uint64_t seed);

}  // namespace obscura
