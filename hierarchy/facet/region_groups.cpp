// Facets of one plane that hang together in a square, and how much of it they cover (region.h).

#include <algorithm>

#include "hierarchy/facet/region.h"

namespace obscura {

RegionJudge::RegionJudge(const PlaneSet& planes, Receivers receivers)
    : planes_(planes), set_(*planes.facets), receivers_(receivers), slot_(set_.facets.size()) {}

bool RegionJudge::look(const Square& square, std::span<const Listed> list) {
    if (list.empty() || list.size() > longest_list) return false;
    square_ = square;
    list_ = list;
    const auto count = static_cast<std::uint32_t>(list.size());
    sets_.reset(count);
    groups_.assign(count, {});
    for (std::uint32_t i = 0; i < count; ++i)
        slot_[list[i].facet] = i;
    for (std::uint32_t i = 0; i < count; ++i)
        unite(i);
    classify();
    return true;
}

/// Joins a facet with its neighbours on the same plane; where it has none, it ends at that edge.
void RegionJudge::unite(std::uint32_t i) {
    const Listed& l = list_[i];
    if (l.covers_all()) return;
    const Facet& f = set_.facets[l.facet];
    for (int k = 0; k < f.edges; ++k) {
        if ((l.crossed >> k & 1u) == 0 || !edge_meets(set_, f, k, square_)) continue;
        const std::uint32_t other = f.neighbour[k];
        const auto count = static_cast<std::uint32_t>(list_.size());
        const std::uint32_t j = other == no_facet ? count : slot_[other];
        if (j < count && list_[j].facet == other && !list_[j].covers_all() &&
            planes_.plane_of[l.facet] != no_plane && planes_.plane_of[other] == planes_.plane_of[l.facet]) {
            sets_.unite(i, j);
            continue;
        }
        Group& g = groups_[i];
        const Line line = line_of(set_, f, k);
        if (g.torn++ == 0) {
            g.line = line;
        } else {
            g.several = true;
        }
    }
}

bool RegionJudge::covers(const Listed& l, std::int32_t x, std::int32_t y) const {
    const Facet& f = set_.facets[l.facet];
    for (int k = 0; k < f.edges; ++k) {
        if ((l.crossed >> k & 1u) != 0 && set_.edge(f, k).at(std::int64_t{x} * subtexel_one + 128,
                                                             std::int64_t{y} * subtexel_one + 128) < 0)
            return false;
    }
    return true;
}

int RegionJudge::weight_at(std::uint32_t root, std::int32_t x, std::int32_t y) const {
    int weight = 0;
    for (std::uint32_t i = 0; i < list_.size(); ++i)
        weight += sets_.parent[i] == root && covers(list_[i], x, y);
    return weight;
}

void RegionJudge::classify() {
    for (std::uint32_t i = 0; i < list_.size(); ++i) {
        const std::uint32_t root = sets_.parent[i] = sets_.root(i);
        Group& g = groups_[root];
        g.low = std::min(g.low, list_[i].low);
        g.member = i;
        if (i == root) continue;
        const Group& own = groups_[i];
        if (own.torn != 0 && g.torn != 0) g.several = true;
        if (own.torn != 0 && g.torn == 0) g.line = own.line;
        g.several = g.several || own.several;
        g.torn += own.torn;
    }
    const std::int32_t last_x = square_.x0 + square_.side - 1, last_y = square_.y0 + square_.side - 1;
    for (std::uint32_t i = 0; i < list_.size(); ++i) {
        if (sets_.parent[i] != i) continue;
        Group& g = groups_[i];
        g.cover = g.several ? Group::some : g.torn != 0 ? Group::side : Group::all;
        if (g.cover == Group::some) continue;
        if (g.cover == Group::all) {
            g.weight = list_[i].covers_all() ? 1 : weight_at(i, square_.x0, square_.y0);
            g.cover = g.weight == 0 ? Group::nothing : g.weight == 1 ? Group::all : Group::some;
            continue;
        }
        // Once on one side and not at all on the other, as corners tell.
        for (const std::int32_t x : {square_.x0, last_x}) {
            for (const std::int32_t y : {square_.y0, last_y}) {
                const bool inside = (facet_distance(g.line.edge, x, y) >= 0) == g.line.inside_high;
                if (weight_at(i, x, y) != (inside ? 1 : 0)) g.cover = Group::some;
            }
        }
    }
}

bool RegionJudge::covers_region(const Group& g, const Side& r) {
    if (g.cover == Group::all) return true;
    return g.cover == Group::side && r.edge != nullptr && g.line.edge == *r.edge &&
           g.line.inside_high == r.high;
}

bool RegionJudge::misses_region(const Group& g, const Side& r) {
    if (g.cover == Group::nothing) return true;
    return g.cover == Group::side && r.edge != nullptr && g.line.edge == *r.edge &&
           g.line.inside_high != r.high;
}

}  // namespace obscura
