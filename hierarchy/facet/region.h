#pragma once
// What is certain about a square, or one side of an edge in it, before any texel is rasterized: that one
// plane comes first everywhere, and how much room there is behind it.
//
// The certificate is about distances between planes, which are affine: what they are at the corners of a
// convex region bounds what they are inside. Surfaces that meet at the region's edge have no distance there,
// and at texels as near to it as vertices move when they snap to the grid, their order may even be the other
// one; these texels are looked at one by one.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/union_find.h"
#include "hierarchy/facet/facet_tree.h"
#include "hierarchy/facet/plane_set.h"
#include "hierarchy/facets.h"
#include "raster/intervals.h"

namespace obscura {

/// Texels of a square on one side of an edge; without `edge`: all.
struct Side {
    Square square;
    const FacetEdge* edge = nullptr;
    bool high = true;
};

/// Judges the facets of one square after the other; keeps its working memory.
class RegionJudge {
  public:
    RegionJudge(const PlaneSet& planes, Receivers receivers);

    /// Takes a look at the list of a square, as Judge::judge() (hierarchy/certificate.h) leaves it. False
    /// when it is too long to bother.
    bool look(const Square& square, std::span<const Listed> list);

    /// One plane, or depths, for all texels of the square.
    std::optional<FacetPart> by_plane();
    /// An edge with a plane, or depths, on either side.
    std::optional<FacetPart> by_edge();

  private:
    static constexpr std::size_t longest_list = 96;
    static constexpr int most_edges = 6;  ///< tried

    /// Facets of one plane that hang together in the square.
    struct Group {
        enum Cover : std::uint8_t { all, side, some, nothing } cover = all;
        int torn = 0;          ///< edges that end it within the square
        bool several = false;  ///< not all of them on one line
        Line line;             ///< of side
        float low = 2.0f;
        std::uint32_t member = 0;  ///< a place in the list
        int weight = 0;
    };
    /// A corner of a region, in texels, and the distance from the region's edge in its own units.
    struct Corner {
        double X, Y, beyond;
    };
    struct Polygon {
        std::array<Corner, 8> at;
        int count = 0;
    };
    /// What is known of a region so far.
    struct Bounds {
        double room = 1;                 ///< for offsets
        double least = 0, most = 1e300;  ///< for the slope of a ramp
        double steepest = 0;             ///< by which surfaces part that meet at the edge
        float behind = 2.0f;             ///< least depth of what may end an interval
        bool ramp = false;
    };

    void unite(std::uint32_t i);
    void classify();
    bool covers(const Listed& l, std::int32_t x, std::int32_t y) const;
    int weight_at(std::uint32_t root, std::int32_t x, std::int32_t y) const;
    const Group& group_of(std::uint32_t i) const { return groups_[sets_.parent[i]]; }

    std::optional<Acceptable> judge(const Side& region);
    /// Whether the group covers all of the region; nothing of it.
    static bool covers_region(const Group& g, const Side& r);
    static bool misses_region(const Group& g, const Side& r);
    Polygon polygon(const Side& region, std::int32_t x0, std::int32_t x1, std::int32_t y0,
                    std::int32_t y1) const;
    Polygon polygon_of(const Side& region, const Listed& l) const;
    bool account(const Side& region, const Listed& q, const Listed& first, bool ends, Bounds& bounds) const;
    bool in_order_near_edge(const Side& region, const Listed& q, const Listed& first) const;
    bool is_closed(const Side& region, const std::vector<std::uint32_t>& present) const;
    const TriangleRecord& record(const Listed& l) const { return set_.plane(set_.facets[l.facet]); }

    const PlaneSet& planes_;
    const FacetSet& set_;
    Receivers receivers_;
    Square square_;
    std::span<const Listed> list_;
    std::vector<std::uint32_t> slot_;
    UnionFind sets_;
    std::vector<Group> groups_;
    std::vector<std::uint32_t> present_;
};

}  // namespace obscura
