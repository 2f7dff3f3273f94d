#pragma once
// What the construction from triangles cuts up: the records of a view as facets that know their neighbours,
// and how a facet lies to a square of texels.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "core/types.h"
#include "raster/coverage.h"
#include "raster/setup.h"

namespace obscura {

constexpr std::uint32_t no_facet = 0xffffffffu;

/// A record, or a pair of them: a convex outline of three or four edges on one depth plane.
struct Facet {
    std::int32_t x_low = 0, x_high = 0, y_low = 0, y_high = 0;  ///< box, fixed point
    float z_low = 0, z_high = 1;  ///< no texel that the facet covers has a depth outside these
    std::uint32_t record = 0;     ///< the first of a pair
    Crossing crossing = Crossing::entry;
    std::uint8_t edges = 3;
    /// Beyond each edge, the facet of the same crossing that walks the edge the other way; no_facet where
    /// there is none. So facets cover samples as often on one side of a shared edge as on the other: how
    /// often a set of facets covers a sample can change only across edges whose neighbour is not in the set.
    std::uint32_t neighbour[4] = {no_facet, no_facet, no_facet, no_facet};
};

/// All facets of a view, in the order of their triangles.
struct FacetSet {
    TriangleSetup setup;
    std::vector<Facet> facets;

    const TriangleRecord& plane(const Facet& f) const { return setup.records[f.record]; }
    EdgeFunction edge(const Facet& f, int k) const {
        const bool second = f.edges == 4 && k >= 2;
        return edge_function(setup.records[f.record + (second ? 1u : 0u)], second ? k - 2 : k);
    }
};

FacetSet facets_of(const Mesh& mesh, const View& view, bool only_casters, const Exec& exec);

/// Texels [x0, x0 + side) x [y0, y0 + side).
struct Square {
    std::int32_t x0 = 0, y0 = 0, side = 1;

    Square child(int i) const {
        const std::int32_t half = side / 2;
        return {x0 + (i % 2) * half, y0 + (i / 2) * half, half};
    }
    // The rectangle of its texels' centres, fixed point.
    std::int32_t left() const { return x0 * subtexel_one + 128; }
    std::int32_t top() const { return y0 * subtexel_one + 128; }
    std::int32_t span() const { return (side - 1) * subtexel_one; }
};

/// A facet in the list of a square that it reaches into.
struct Listed {
    std::uint32_t facet = 0;
    std::uint32_t crossed = 0;  ///< bit k: the line of edge k has centres of the square on both sides
    float low = 0,
          high = 1;  ///< bounds of its depth at the texels that it may cover; exact when it covers all
    bool covers_all() const { return crossed == 0; }
};

/// How facet `f` lies to `square`: nothing when it covers no point between the square's centres. `crossed`
/// may leave out edges that are known to have all of the square inside.
std::optional<Listed> place(const FacetSet& set, std::uint32_t f, std::uint32_t crossed,
                            const Square& square);

/// Whether edge k itself, not only its line, meets the rectangle of the square's centres.
bool edge_meets(const FacetSet& set, const Facet& f, int k, const Square& square);

/// Least and greatest depth that the plane takes at centres of columns [x0, x1] and rows [y0, y1]: its own
/// values at two corners, since it is monotone in x and in y.
struct DepthRange {
    float low = 0, high = 1;
};
DepthRange plane_range(const TriangleRecord& plane, std::int32_t x0, std::int32_t x1, std::int32_t y0,
                       std::int32_t y1);

}  // namespace obscura
