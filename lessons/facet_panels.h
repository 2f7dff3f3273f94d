#pragma once
// Trees of planes and edges as squares that can be painted (lesson 25).

#include <vector>

#include "core/vec.h"
#include "hierarchy/facet/facet_tree.h"

namespace obscura {

/// A leaf of a tree with planes and edges, and the square that it is, in texels.
struct FacetSquare {
    int x = 0, y = 0, side = 1;
    const FacetNode* node = nullptr;  ///< null: all is inherited
    bool line = false;                ///< it has an edge
};

/// Every leaf, and every quadrant that inherits all.
std::vector<FacetSquare> squares_of(const FacetTree& tree);

/// Where an edge crosses a square, in texels of the map: two points, or none.
std::vector<Vec2d> crossing(const FacetEdge& edge, const FacetSquare& square);

/// The largest leaf one of whose sides has a plane on a ramp, and whose border its edge meets twice; null:
/// none.
const FacetSquare* largest_ramp(const FacetTree& tree, const std::vector<FacetSquare>& squares);

/// The row of a square on which its edge is nearest to the middle.
int middle_row(const FacetEdge& edge, const FacetSquare& square);

}  // namespace obscura
