#pragma once
// The planes and edges of a view's facets, under names that are equal where they are.

#include <cstdint>
#include <vector>

#include "hierarchy/facet/facet_tree.h"
#include "hierarchy/facets.h"

namespace obscura {

/// A facet set whose planes are numbered; facets of one planar face have one number.
struct PlaneSet {
    const FacetSet* facets = nullptr;
    std::vector<std::uint32_t> plane_of;  ///< per facet; no_plane: one that no value can name
    std::vector<FacetPlane> planes;
};

/// `facets` must outlive it.
PlaneSet planes_of(const FacetSet& facets);

/// An edge as a line, the same from both of its sides.
struct Line {
    FacetEdge edge;
    bool inside_high = false;  ///< the facet lies where the edge's form is not negative
};
Line line_of(const FacetSet& set, const Facet& facet, int k);

}  // namespace obscura
