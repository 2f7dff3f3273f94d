#include "hierarchy/facet/facet_tree.h"

#include <algorithm>
#include <bit>

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
    while (steepest < static_cast<int>(facet_no_ramp) && slope_of(steepest) > most)
        ++steepest;
    int flattest = static_cast<int>(facet_no_ramp) - 1;
    while (flattest >= steepest && slope_of(flattest) < least)
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
