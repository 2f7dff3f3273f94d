#pragma once
// Trees whose leaves hold planes and edges, before they are bits.
//
// Every square has depths, or a plane, that all of its texels can take; one that has neither may have an edge
// with such a value on either side. Parents take what most of their children can (L. Scandolo, P. Bauszat,
// E. Eisemann, "Compressed Multiresolution Hierarchies for High-Quality Precomputed Shadows", Eurographics
// 2016, algorithm 2, with planes for depths as well), and children that can take it too have nothing of their
// own.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types.h"
#include "hierarchy/certain_tree.h"
#include "hierarchy/facet/facet_format.h"
#include "hierarchy/facets.h"
#include "hierarchy/multires.h"

namespace obscura {

constexpr std::uint32_t no_plane = 0xffffffffu, no_edge = 0xffffffffu;

/// A value of a node: a depth, or a plane with its cap and ramp (facet_format.h).
struct FacetValue {
    std::uint32_t plane = no_plane;
    std::uint32_t bits = 0;  ///< of the depth; else cap | ramp << 5
    friend bool operator==(const FacetValue&, const FacetValue&) = default;
};
FacetValue depth_value(float depth);
constexpr FacetValue plane_value(std::uint32_t plane, std::uint32_t cap, std::uint32_t ramp) {
    return {plane, cap | ramp << 5};
}

/// Least offset behind a plane that receivers on it are to have, where its texels' intervals are wide enough:
/// eight times what rounding does to a depth.
constexpr float least_offset = 0x1p-21f;

constexpr int no_ramp_needed = -1;

/// What all texels of a square, or of one side of it, can take.
struct Acceptable {
    DepthInterval depths = no_common_depth;
    /// A plane, and least and greatest offset from it.
    std::uint32_t plane = no_plane;
    float need = 0, room = 0;
    /// On a side of an edge, the ramps that the offset may have: from the steepest, none for any, to the
    /// flattest.
    int steepest = no_ramp_needed, flattest = static_cast<int>(facet_no_ramp) - 1;

    bool takes_depths() const { return has_depth(depths); }
    bool takes_plane() const { return plane != no_plane; }
    bool empty() const { return !takes_depths() && !takes_plane(); }
};

/// What a ramp rises by in a unit of the edge's distance.
inline double slope_of(int ramp) {
    return double{facet_power(static_cast<std::uint32_t>(ramp))};
}

/// Whether some offset that values can have lies between these.
bool offset_between(float need, float room);
/// A plane whose offset rises from the edge by no more than `most` a unit of its distance, and no less than
/// `least`, up to `room`; empty where no ramp does.
Acceptable with_ramp(std::uint32_t plane, float room, double most, double least);
/// Takes over the plane of `from`, with all that goes with it.
void take_plane(Acceptable& a, const Acceptable& from);
/// What both can take, `a` afterwards; false: nothing.
bool narrow(Acceptable& a, const Acceptable& other);
/// What both can take of the one plane that they have; false, and no change: nothing.
bool narrow_plane(Acceptable& a, const Acceptable& other);
/// The value that is stored for what is acceptable: well inside.
FacetValue stored_value(const Acceptable& a);

/// A finished part of the tree. Without `edge`: value[0]. With it: value[0] on its low side, value[1] on the
/// high one, and nothing below.
struct FacetPart {
    Acceptable value[2];
    bool has_edge = false;
    FacetEdge edge;
    std::uint32_t kinds = 0;  ///< of its children, three bits each
    std::uint64_t first_child = 0;

    static FacetPart of(const Acceptable& a) {
        FacetPart part;
        part.value[0] = a;
        return part;
    }
    static FacetPart of(DepthInterval depths) {
        Acceptable a;
        a.depths = depths;
        return of(a);
    }
};

/// A node; its children that exist stand together, in child order.
struct FacetNode {
    FacetValue value[2];           ///< of what it has of its own: leaf and full the first; lines low, high
    std::uint32_t edge = no_edge;  ///< of lines: index into FacetTree::edges
    std::uint32_t kinds = 0;
    std::uint64_t first_child = 0;

    std::uint32_t child(int i) const { return kinds >> (3 * i) & 7u; }
};

/// A tree over 2^levels texels a side. Its root has a value and is no line.
struct FacetTree {
    int levels = 0;
    FacetNode root;
    std::vector<FacetNode> nodes;
    std::vector<FacetEdge> edges;  ///< one may stand in it several times
    std::vector<FacetPlane> planes;
};

/// Collects a tree from its finished parts, children before parents.
class FacetBuilder {
  public:
    /// Of the quadrants of `square`. `as_root`: no edge for the square itself.
    FacetPart join(const FacetPart (&child)[4], const Square& square, bool as_root = false);
    /// Appends another builder's nodes; returns what to add to its parts' first_child.
    std::uint64_t append(const FacetBuilder& other);
    FacetNode node_of(const FacetPart& part);

    const std::vector<FacetPlane>* planes = nullptr;  ///< that parts name, to try them where depths are wide
    std::vector<FacetNode> nodes;
    std::vector<FacetEdge> edges;
};

/// A tree of depths alone, in the same form.
FacetTree facet_tree_of(const MultiresTree& tree);

}  // namespace obscura
