// Quadrants to their square: who shares a value, and who an edge.

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "hierarchy/combine.h"
#include "hierarchy/facet/facet_tree.h"

namespace obscura {
namespace {

using Planes = std::vector<FacetPlane>;

/// One place where a value may be saved: a child, or a side of a child with an edge.
struct Slot {
    const Acceptable* wants;
    Square square;
    int child = 0, side = 0;
    bool at_edge = false;  ///< a ramp would count: from its edge, or from those of what is below it
    double beyond = 0;     ///< least distance from an edge, less its ramps' start
};

float rounded_up(double a) {
    const auto f = static_cast<float>(a);
    return static_cast<double>(f) < a ? std::nextafterf(f, 2.0f) : f;
}

/// What the slot can take of a plane that is not its own: one that, moved, stays within its depths. The plane
/// is monotone in x and y, so corners tell.
Acceptable on_plane(const Slot& slot, std::uint32_t plane, const Planes* planes) {
    if (slot.wants->plane == plane) return *slot.wants;
    Acceptable a;
    if (planes == nullptr || !slot.wants->takes_depths()) return a;
    const Square& s = slot.square;
    float low = 2.0f, high = -1.0f;
    for (const std::int32_t x : {s.x0, s.x0 + s.side - 1}) {
        for (const std::int32_t y : {s.y0, s.y0 + s.side - 1}) {
            const float z = facet_plane_depth((*planes)[plane], x, y);
            low = std::min(low, z);
            high = std::max(high, z);
        }
    }
    const DepthInterval& depths = slot.wants->depths;
    const double away = std::min(double{least_offset}, (double{depths.exit} - double{depths.entry}) / 16);
    const float need = std::max(0.0f, rounded_up(double{depths.entry} - double{low} + away));
    const float room = std::min(1.0f, -rounded_up(double{high} - double{depths.exit} + away));
    if (!offset_between(need, room)) return a;
    a.plane = plane;
    a.need = need;
    a.room = room;
    if (slot.at_edge && double{depths.entry} > double{low}) {
        // A ramp must have risen so far by there, whatever is rounded.
        a.flattest = no_ramp_needed;
        while (a.flattest + 1 < static_cast<int>(facet_no_ramp) &&
               slope_of(a.flattest + 1) * slot.beyond >= 2.0 * double{need})
            ++a.flattest;
    }
    return a;
}

/// What a parent may take, and the slots that can take it too.
struct Choice {
    Acceptable value;
    unsigned covered = 0;
    int count() const { return std::popcount(covered); }
};

Choice best_depth(const Slot (&slots)[8], int n) {
    Choice best;
    for (int c = 0; c < n; ++c) {
        if (!slots[c].wants->takes_depths()) continue;
        const float depth = slots[c].wants->depths.entry;
        Choice choice;
        for (int i = 0; i < n; ++i) {
            const DepthInterval& d = slots[i].wants->depths;
            if (!has_depth(d) || !contains(d, depth)) continue;
            choice.value.depths = choice.covered == 0 ? d : common_depths(choice.value.depths, d);
            choice.covered |= 1u << i;
        }
        if (choice.count() > best.count()) best = choice;
    }
    return best;
}

Choice best_plane(const Slot (&slots)[8], int n, const Planes* planes) {
    Choice best;
    for (int c = 0; c < n; ++c) {
        const std::uint32_t plane = slots[c].wants->plane;
        const bool tried =
            std::any_of(slots, slots + c, [&](const Slot& s) { return s.wants->plane == plane; });
        if (plane == no_plane || tried) continue;
        Choice choice;
        take_plane(choice.value, *slots[c].wants);
        choice.covered = 1u << c;
        // Its own before those that it suits.
        for (const bool own : {true, false}) {
            for (int i = 0; i < n; ++i) {
                if (i == c || (slots[i].wants->plane == plane) != own) continue;
                const Acceptable a = on_plane(slots[i], plane, planes);
                if (a.takes_plane() && narrow_plane(choice.value, a)) choice.covered |= 1u << i;
            }
        }
        if (choice.count() > best.count()) best = choice;
    }
    return best;
}

Choice best_choice(const Slot (&slots)[8], int n, const Planes* planes) {
    const Choice depth = best_depth(slots, n), plane = best_plane(slots, n, planes);
    Choice best = plane.count() > depth.count() ? plane : depth;
    if (plane.covered == depth.covered) take_plane(best.value, plane.value);
    return best;
}

/// What all of these can take; empty: nothing.
Acceptable common_to_all(const std::vector<Slot>& slots, const Planes* planes) {
    Acceptable all = *slots[0].wants;
    if (std::all_of(slots.begin() + 1, slots.end(), [&](const Slot& s) { return narrow(all, *s.wants); }))
        return all;
    for (std::size_t c = 0; c < slots.size(); ++c) {
        const std::uint32_t plane = slots[c].wants->plane;
        if (plane == no_plane) continue;
        all = {};
        take_plane(all, *slots[c].wants);
        const bool fits = std::all_of(slots.begin(), slots.end(), [&](const Slot& s) {
            const Acceptable a = on_plane(s, plane, planes);
            return a.takes_plane() && narrow_plane(all, a);
        });
        if (fits) return all;
    }
    return {};
}

/// How far, at least, a square on one side of an edge is from where its ramps start; not above zero where
/// texels lie on both sides.
double least_beyond(const Square& square, const FacetEdge& edge, int side) {
    double least = 1e300;
    for (const std::int32_t x : {square.x0, square.x0 + square.side - 1}) {
        for (const std::int32_t y : {square.y0, square.y0 + square.side - 1}) {
            const double d = facet_distance(edge, x, y);
            least = std::min(least, side == 1 ? d : -d);
        }
    }
    return least - facet_ramp_start(edge);
}

/// On which sides of an edge a square has texels: bit 0 low, bit 1 high.
unsigned sides_of(const Square& square, const FacetEdge& edge) {
    unsigned sides = 0;
    for (const std::int32_t x : {square.x0, square.x0 + square.side - 1}) {
        for (const std::int32_t y : {square.y0, square.y0 + square.side - 1})
            sides |= facet_distance(edge, x, y) >= 0 ? 2u : 1u;
    }
    return sides;
}

/// Quadrants without anything below them, all of whose edges are one: the square has it itself, if on each
/// side of it all can take the same.
std::optional<FacetPart> joined_by_edge(const FacetPart (&child)[4], const Square& square,
                                        const Planes* planes) {
    const FacetEdge* edge = nullptr;
    for (const FacetPart& c : child) {
        if (c.kinds != 0 || (c.has_edge && edge != nullptr && !(c.edge == *edge))) return {};
        if (c.has_edge) edge = &c.edge;
    }
    if (edge == nullptr) return {};
    FacetPart part;
    part.has_edge = true;
    part.edge = *edge;
    for (int side = 0; side < 2; ++side) {
        std::vector<Slot> slots;
        for (int i = 0; i < 4; ++i) {
            const FacetPart& c = child[i];
            const Square quadrant = square.child(i);
            if (c.has_edge) {
                slots.push_back({&c.value[side], quadrant, i, side, true, 0});
            } else if ((sides_of(quadrant, *edge) >> side & 1u) != 0) {
                slots.push_back({&c.value[0], quadrant, i, side, true, least_beyond(quadrant, *edge, side)});
            }
        }
        if (!slots.empty()) part.value[side] = common_to_all(slots, planes);
        if (part.value[side].empty()) return {};
    }
    return part;
}

}  // namespace

FacetPart FacetBuilder::join(const FacetPart (&child)[4], const Square& square, bool as_root) {
    if (!as_root) {
        if (const std::optional<FacetPart> line = joined_by_edge(child, square, planes)) return *line;
    }
    Slot slots[8];
    int n = 0;
    for (int i = 0; i < 4; ++i) {
        // Ramps count everywhere: a quadrant without an edge may get one with its square, further up.
        for (int side = 0; side < (child[i].has_edge ? 2 : 1); ++side)
            slots[n++] = {&child[i].value[side], square.child(i), i, side, true, 0};
    }
    const Choice choice = best_choice(slots, n, planes);

    FacetPart part;
    part.value[0] = choice.value;
    part.first_child = nodes.size();
    bool covered[4][2] = {};
    for (int k = 0; k < n; ++k)
        covered[slots[k].child][slots[k].side] = (choice.covered >> k & 1u) != 0;
    for (int i = 0; i < 4; ++i) {
        const FacetPart& c = child[i];
        std::uint32_t kind = 0;
        if (c.has_edge) {
            // Without its edge a value would have no ramp.
            for (int side = 0; side < 2; ++side) {
                if (covered[i][0] && covered[i][1] && choice.value.takes_plane() &&
                    c.value[side].takes_plane() && c.value[side].steepest != no_ramp_needed)
                    covered[i][side] = false;
            }
            const std::uint32_t own =
                (covered[i][0] ? 0 : facet_own_low) | (covered[i][1] ? 0 : facet_own_high);
            kind = own == 0 ? 0 : facet_line | own;
        } else {
            const bool own = !covered[i][0] && !c.value[0].empty();
            kind = (own ? facet_leaf : 0) | (c.kinds != 0 ? facet_empty : 0);
        }
        if (kind == 0) continue;
        part.kinds |= kind << (3 * i);
        nodes.push_back(node_of(c));
    }
    return part;
}

}  // namespace obscura
