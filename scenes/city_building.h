#pragma once

#include "core/mesh.h"
#include "scenes/city_plan.h"

namespace obscura {

/// Material slots of a town, in this order.
namespace city_slot {
enum : std::uint32_t {
    asphalt,
    kerb,
    sidewalk,
    lawn,
    setts,
    facade,
    trim = facade + 6,
    pane,
    pane_lit,
    roof_tile,
    roof_slate,
    roof_flat,
    metal,
    wood,
    bark,
    leaf,
    count
};
}

constexpr int city_levels = 7;  ///< levels of detail 0 .. city_levels - 1

/// An item at a level of detail, about the origin, its street front towards +Z. A higher level never has
/// fewer triangles; trees and lamps are empty at level 0.
Mesh build_city_item(const CityItem& item, int level);

}  // namespace obscura
