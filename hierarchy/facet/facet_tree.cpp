#include "hierarchy/facet/facet_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "hierarchy/combine.h"

namespace obscura {
namespace {

/// The greatest cap whose offset is at most `offset`; facet_no_cap: none.
std::uint32_t cap_below(float offset) {
    std::uint32_t cap = 0;
    while (cap < facet_no_cap && facet_power(cap + 1) > offset)
        ++cap;
    return cap;
}
float offset_of(std::uint32_t cap) {
    return cap == facet_no_cap ? 0.0f : facet_power(cap + 1);
}

/// One place where a value may be saved: a child, or a side of a child with an edge.
struct Slot {
    const Acceptable* wants;
    int child, side;
};

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

Choice best_plane(const Slot (&slots)[8], int n) {
    Choice best;
    for (int c = 0; c < n; ++c) {
        const Acceptable& first = *slots[c].wants;
        if (!first.takes_plane()) continue;
        Choice choice;
        take_plane(choice.value, first);
        choice.covered = 1u << c;
        for (int i = 0; i < n; ++i) {
            if (i == c || slots[i].wants->plane != first.plane) continue;
            if (narrow_plane(choice.value, *slots[i].wants)) choice.covered |= 1u << i;
        }
        if (choice.count() > best.count()) best = choice;
    }
    return best;
}

Choice best_choice(const Slot (&slots)[8], int n) {
    const Choice depth = best_depth(slots, n), plane = best_plane(slots, n);
    Choice best = plane.count() > depth.count() ? plane : depth;
    if (plane.covered == depth.covered) {
        take_plane(best.value, plane.value);
    }
    return best;
}

/// On which sides of an edge a square has texels: bit 0 low, bit 1 high.
unsigned sides_of(const Square& square, const FacetEdge& edge) {
    const std::int32_t last_x = square.x0 + square.side - 1, last_y = square.y0 + square.side - 1;
    unsigned sides = 0;
    for (const std::int32_t x : {square.x0, last_x}) {
        for (const std::int32_t y : {square.y0, last_y})
            sides |= facet_distance(edge, x, y) >= 0 ? 2u : 1u;
    }
    return sides;
}

/// Quadrants without anything below them, all of whose edges are one: the square has it itself, if on each
/// side of it all can take the same.
std::optional<FacetPart> joined_by_edge(const FacetPart (&child)[4], const Square& square) {
    const FacetEdge* edge = nullptr;
    for (const FacetPart& c : child) {
        if (c.kinds != 0 || (c.has_edge && edge != nullptr && !(c.edge == *edge))) return {};
        if (c.has_edge) edge = &c.edge;
    }
    if (edge == nullptr) return {};
    FacetPart part;
    part.has_edge = true;
    part.edge = *edge;
    unsigned met = 0;
    const auto add = [&](int side, const Acceptable& a) {
        Acceptable& own = part.value[side];
        const bool first = (met >> side & 1u) == 0;
        met |= 1u << side;
        if (first) own = a;
        return first || narrow(own, a);
    };
    for (int i = 0; i < 4; ++i) {
        const FacetPart& c = child[i];
        if (c.has_edge) {
            if (!add(0, c.value[0]) || !add(1, c.value[1])) return {};
            continue;
        }
        const unsigned sides = sides_of(square.child(i), *edge);
        for (int side = 0; side < 2; ++side) {
            if ((sides >> side & 1u) != 0 && !add(side, c.value[0])) return {};
        }
    }
    return part;
}

}  // namespace

FacetValue depth_value(float depth) {
    return {no_plane, std::bit_cast<std::uint32_t>(depth)};
}

bool offset_between(float need, float room) {
    if (room < 0) return false;
    return offset_of(cap_below(room)) >= need;
}

Acceptable with_ramp(std::uint32_t plane, float room, double most, double least) {
    Acceptable a;
    int steepest = 0;
    while (steepest < static_cast<int>(facet_no_ramp) && std::ldexp(1.0, -steepest) > most)
        ++steepest;
    int flattest = static_cast<int>(facet_no_ramp) - 1;
    while (flattest >= steepest && std::ldexp(1.0, -flattest) < least)
        --flattest;
    if (steepest > flattest || !offset_between(least_offset, room)) return a;
    a.plane = plane;
    a.need = least_offset;
    a.room = room;
    a.steepest = steepest;
    a.flattest = flattest;
    return a;
}

void take_plane(Acceptable& a, const Acceptable& from) {
    a.plane = from.plane;
    a.need = from.need;
    a.room = from.room;
    a.steepest = from.steepest;
    a.flattest = from.flattest;
}

bool narrow(Acceptable& a, const Acceptable& other) {
    Acceptable both;
    both.depths = common_depths(a.depths, other.depths);
    if (a.takes_plane() && a.plane == other.plane) {
        take_plane(both, a);
        if (!narrow_plane(both, other)) both.plane = no_plane;
    }
    if (both.empty()) return false;
    a = both;
    return true;
}

bool narrow_plane(Acceptable& a, const Acceptable& other) {
    const float need = std::max(a.need, other.need), room = std::min(a.room, other.room);
    const int steepest = std::max(a.steepest, other.steepest),
              flattest = std::min(a.flattest, other.flattest);
    if (!offset_between(need, room) || steepest > flattest) return false;
    a.need = need;
    a.room = room;
    a.steepest = steepest;
    a.flattest = flattest;
    return true;
}

FacetValue stored_value(const Acceptable& a) {
    if (a.takes_plane()) {
        std::uint32_t cap = cap_below(a.room * 0.5f);
        if (offset_of(cap) < a.need) cap = cap_below(a.room);
        // The middle of the depths may be nearer to its ends than the plane's value to what is before and
        // behind.
        if (!a.takes_depths() ||
            (a.depths.exit - a.depths.entry) * 0.5f < std::min(offset_of(cap), least_offset))
            return plane_value(
                a.plane, cap,
                a.steepest == no_ramp_needed ? facet_no_ramp : static_cast<std::uint32_t>(a.steepest));
    }
    return depth_value(stored_depth(a.depths));
}

FacetNode FacetBuilder::node_of(const FacetPart& part) {
    FacetNode node;
    node.kinds = part.kinds;
    node.first_child = part.first_child;
    if (part.has_edge) {
        node.edge = static_cast<std::uint32_t>(edges.size());
        edges.push_back(part.edge);
        node.value[0] = stored_value(part.value[0]);
        node.value[1] = stored_value(part.value[1]);
    } else if (!part.value[0].empty()) {
        node.value[0] = stored_value(part.value[0]);
    }
    return node;
}

FacetPart FacetBuilder::join(const FacetPart (&child)[4], const Square& square, bool as_root) {
    if (!as_root) {
        if (const std::optional<FacetPart> line = joined_by_edge(child, square)) return *line;
    }
    Slot slots[8];
    int n = 0;
    for (int i = 0; i < 4; ++i) {
        for (int side = 0; side < (child[i].has_edge ? 2 : 1); ++side)
            slots[n++] = {&child[i].value[side], i, side};
    }
    const Choice choice = best_choice(slots, n);

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

std::uint64_t FacetBuilder::append(const FacetBuilder& other) {
    const std::uint64_t offset = nodes.size();
    const auto first_edge = static_cast<std::uint32_t>(edges.size());
    nodes.reserve(nodes.size() + other.nodes.size());
    for (FacetNode node : other.nodes) {
        node.first_child += offset;
        if (node.edge != no_edge) node.edge += first_edge;
        nodes.push_back(node);
    }
    edges.insert(edges.end(), other.edges.begin(), other.edges.end());
    return offset;
}

FacetTree facet_tree_of(const MultiresTree& tree) {
    const auto node_of = [](const MultiresNode& from) {
        FacetNode node;
        node.value[0] = depth_value(from.value);
        node.first_child = from.first_child();
        for (int i = 0; i < 4; ++i)
            node.kinds |= static_cast<std::uint32_t>(from.child(i)) << (3 * i);
        return node;
    };
    FacetTree result;
    result.levels = tree.levels;
    result.root = node_of(tree.root);
    result.nodes.reserve(tree.nodes.size());
    for (const MultiresNode& node : tree.nodes)
        result.nodes.push_back(node_of(node));
    return result;
}

}  // namespace obscura
