#pragma once
// Building bodies: boxes whose fronts are grids of wall and window cells. Used by the house and by the city.

#include <vector>

#include "core/mesh.h"

namespace obscura {

/// One front: where the window cells lie, in metres along it and up it. Cells span all pairs of a column and
/// a row; windows do not touch each other, the corners or the top.
struct WindowGrid {
    std::vector<Vec2d> columns;  ///< [left, right] of the windows of each column, ascending, along the front
    std::vector<Vec2d> rows;     ///< [sill, head] of each storey, ascending
};

/// What the openings of a body look like.
struct BodyParams {
    double width_m = 10, depth_m = 8, height_m = 6;
    WindowGrid wide, deep;   ///< of the fronts along X (+Z and -Z) and along Z (+X and -X); same rows
    double reveal_m = 0.18;  ///< how far the panes lie back
};

/// A closed, welded box from y = 0 with its windows pressed in. Slots: walls get wall_slot, panes pane_slot.
/// Without windows it is a plain box of 12 triangles.
Mesh building_body(const BodyParams& params, std::uint32_t wall_slot, std::uint32_t pane_slot);

/// `count` windows of window_m spread evenly over a front of `length_m`.
std::vector<Vec2d> even_openings(double length_m, int count, double window_m);

/// A wall between z = -depth/2 and +depth/2, centred on x, whose grid cells are open right through.
Mesh pierced_slab(double width_m, double height_m, double depth_m, const WindowGrid& openings);

}  // namespace obscura
