#include "hierarchy/facet/region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raster/coverage.h"

namespace obscura {
namespace {

/// What sums of so large terms may be off by, many times over.
double slack_of(double terms) {
    return 0x1p-44 * terms;
}

/// The plane's depth at a corner, not clamped, and the size of its terms.
struct PlaneAt {
    double z, terms;
};
PlaneAt affine_at(const TriangleRecord& t, double X, double Y) {
    return {t.a * X + (t.b * Y + t.c), std::fabs(t.a * X) + std::fabs(t.b * Y) + std::fabs(t.c)};
}

float clamped(const TriangleRecord& t, double z) {
    const auto f = static_cast<float>(z);
    return std::max(std::min(f, t.zmax), t.zmin);
}

double signed_distance(const FacetEdge& e, double x, double y) {
    return static_cast<double>(e.a) * x + (static_cast<double>(e.b) * y + e.c);
}

}  // namespace

/// The part of these texels' centres' rectangle that lies in the region.
RegionJudge::Polygon RegionJudge::polygon(const Side& region, std::int32_t x0, std::int32_t x1,
                                          std::int32_t y0, std::int32_t y1) const {
    Polygon p;
    const std::int32_t xs[4] = {x0, x1, x1, x0}, ys[4] = {y0, y0, y1, y1};
    double beyond[4] = {};
    for (int i = 0; i < 4; ++i) {
        if (region.edge == nullptr) {
            p.at[static_cast<std::size_t>(p.count++)] = {xs[i] + 0.5, ys[i] + 0.5, 0};
            continue;
        }
        const double d = signed_distance(*region.edge, xs[i], ys[i]);
        beyond[i] = region.high ? d : -d;
    }
    if (region.edge == nullptr) return p;
    for (int i = 0; i < 4; ++i) {
        const int next = (i + 1) % 4;
        if (beyond[i] >= 0) p.at[static_cast<std::size_t>(p.count++)] = {xs[i] + 0.5, ys[i] + 0.5, beyond[i]};
        if ((beyond[i] >= 0) == (beyond[next] >= 0)) continue;
        const double t = beyond[i] / (beyond[i] - beyond[next]);
        p.at[static_cast<std::size_t>(p.count++)] = {xs[i] + 0.5 + t * (xs[next] - xs[i]),
                                                     ys[i] + 0.5 + t * (ys[next] - ys[i]), 0};
    }
    return p;
}

/// The part of the region that the facet's box reaches into.
RegionJudge::Polygon RegionJudge::polygon_of(const Side& region, const Listed& l) const {
    const Square& s = region.square;
    const std::int32_t last_x = s.x0 + s.side - 1, last_y = s.y0 + s.side - 1;
    if (l.covers_all()) return polygon(region, s.x0, last_x, s.y0, last_y);
    const Facet& f = set_.facets[l.facet];
    const std::int32_t x0 = std::max((f.x_low - 128 + 255) >> subtexel_bits, s.x0);
    const std::int32_t x1 = std::min((f.x_high - 128) >> subtexel_bits, last_x);
    const std::int32_t y0 = std::max((f.y_low - 128 + 255) >> subtexel_bits, s.y0);
    const std::int32_t y1 = std::min((f.y_high - 128) >> subtexel_bits, last_y);
    if (x0 > x1 || y0 > y1) return {};
    return polygon(region, x0, x1, y0, y1);
}

/// What `q`, which is not on the first plane, means for values behind that. `ends`: intervals may end at it;
/// else it must only not come first. False: it may come first.
bool RegionJudge::account(const Side& region, const Listed& q, const Listed& first, bool ends,
                          Bounds& bounds) const {
    const Polygon p = polygon_of(region, q);
    if (p.count == 0) return true;
    const TriangleRecord &tq = record(q), &tp = record(first);
    double gap[8], least = 1e300, z_least = 1e300, p_most = -1e300;
    bool clamps = false;
    for (int i = 0; i < p.count; ++i) {
        const Corner& c = p.at[static_cast<std::size_t>(i)];
        const PlaneAt zq = affine_at(tq, c.X, c.Y), zp = affine_at(tp, c.X, c.Y);
        const double slack = slack_of(zq.terms + zp.terms);
        gap[i] = zq.z - zp.z - slack;
        least = std::min(least, gap[i]);
        z_least = std::min(z_least, zq.z - slack);
        p_most = std::max(p_most, zp.z + slack);
        clamps = clamps || zq.z + slack > tq.zmax || zp.z - slack < tp.zmin;
    }
    // Where depths are clamped to those of their faces, they are nearer to each other than the planes.
    const double clamped_gap =
        clamps ? std::min({tq.zmax - std::max(p_most, double{tp.zmin}), z_least - tp.zmin, 1.0}) : 1.0;
    if (ends) bounds.behind = std::min(bounds.behind, std::max(clamped(tq, z_least), q.low));
    const double enough = 2.0 * double{least_offset};
    if (std::min(least, clamped_gap) >= enough) {
        if (ends) bounds.room = std::min(bounds.room, std::min(least, clamped_gap) / 2);
        return true;
    }
    if (!ends && std::min(least, clamped_gap) >= 0) return true;
    if (region.edge == nullptr || clamped_gap < enough) return false;

    // They meet: the distance has to grow with that from the edge.
    const double start = facet_ramp_start(*region.edge);
    double most = 1e300, needed = 0, far = 0, steepest = 0;
    bool crosses = false;
    for (int i = 0; i < p.count; ++i) {
        const double beyond = p.at[static_cast<std::size_t>(i)].beyond - start;
        if (beyond > 0) {
            if (gap[i] <= 0) return false;
            most = std::min(most, gap[i] / (8 * beyond));
            if (beyond > far) {
                far = beyond;
                steepest = gap[i] / beyond;
            }
        } else if (gap[i] < 0) {
            if (beyond == 0) return false;
            crosses = true;
            needed = std::max(needed, gap[i] / (8 * beyond));
        }
    }
    if (needed > most) return false;
    if (crosses && !in_order_near_edge(region, q, first)) return false;
    if (!ends) return true;
    bounds.ramp = true;
    bounds.most = std::min(bounds.most, most);
    bounds.least = std::max(bounds.least, needed);
    bounds.steepest = std::max(bounds.steepest, steepest);
    return true;
}

/// Whether `q` lies nowhere before the first plane at texels up to where ramps start. At most one of a row,
/// or of a column where the edge is rather level.
bool RegionJudge::in_order_near_edge(const Side& region, const Listed& q, const Listed& first) const {
    const FacetEdge& e = *region.edge;
    const Square& s = region.square;
    const TriangleRecord &tq = record(q), &tp = record(first);
    const double start = facet_ramp_start(e);
    const bool by_rows = std::abs(std::int64_t{e.a}) >= std::abs(std::int64_t{e.b});
    const double step = by_rows ? e.a : e.b, along = by_rows ? e.b : e.a;
    const std::int32_t from = by_rows ? s.x0 : s.y0, row0 = by_rows ? s.y0 : s.x0;
    for (std::int32_t row = row0; row < row0 + s.side; ++row) {
        const double zero = -(along * row + e.c) / step;
        if (zero < from - 2.0 || zero > from + s.side + 1.0) continue;
        const auto middle = static_cast<std::int32_t>(std::floor(zero));
        for (std::int32_t at = std::max(middle - 1, from); at <= std::min(middle + 2, from + s.side - 1);
             ++at) {
            const std::int32_t x = by_rows ? at : row, y = by_rows ? row : at;
            const double d = signed_distance(e, x, y), beyond = region.high ? d : -d;
            if ((d >= 0) != region.high || beyond > start || !covers(q, x, y)) continue;
            if (depth_at(tq, x + 0.5, y + 0.5) < depth_at(tp, x + 0.5, y + 0.5)) return false;
        }
    }
    return true;
}

/// Receivers::any: whether the counter, one after the first plane, is certain to come back to zero: at a back
/// face that covers the region and has no more front faces before it than back faces.
bool RegionJudge::is_closed(const Side& region, const std::vector<std::uint32_t>& present) const {
    const auto crossing_of = [&](std::uint32_t i) { return set_.facets[list_[i].facet].crossing; };
    // A group's greatest depth is that of its plane over the whole region, whatever member is asked.
    const auto whole_depth = [&](std::uint32_t i) {
        Listed whole = list_[i];
        whole.crossed = 0;
        const Polygon p = polygon_of(region, whole);
        double most = -1e300;
        for (int k = 0; k < p.count; ++k) {
            const Corner& c = p.at[static_cast<std::size_t>(k)];
            const PlaneAt z = affine_at(record(whole), c.X, c.Y);
            most = std::max(most, z.z + slack_of(z.terms));
        }
        return clamped(record(whole), most);
    };
    for (const std::uint32_t last : present) {
        if (crossing_of(last) != Crossing::exit || sets_.parent[last] != last ||
            !covers_region(group_of(last), region))
            continue;
        const float z = whole_depth(last);
        int surplus = 0;
        for (const std::uint32_t i : present) {
            const Group& g = group_of(i);
            const bool covering = covers_region(g, region);
            if (covering && sets_.parent[i] != i) continue;
            if (crossing_of(i) == Crossing::entry && (covering ? g.low : list_[i].low) <= z) ++surplus;
            if (crossing_of(i) == Crossing::exit && covering && whole_depth(i) <= z) --surplus;
        }
        if (surplus <= 0) return true;
    }
    return false;
}

std::optional<Acceptable> RegionJudge::judge(const Side& region) {
    const Polygon whole = polygon(region, region.square.x0, region.square.x0 + region.square.side - 1,
                                  region.square.y0, region.square.y0 + region.square.side - 1);
    if (whole.count == 0) return {};
    double X = 0, Y = 0;
    for (int i = 0; i < whole.count; ++i) {
        X += whole.at[static_cast<std::size_t>(i)].X / whole.count;
        Y += whole.at[static_cast<std::size_t>(i)].Y / whole.count;
    }
    // The first of those that cover all of it.
    const Listed* first = nullptr;
    double nearest = 1e300;
    present_.clear();
    for (std::uint32_t i = 0; i < list_.size(); ++i) {
        const Group& g = group_of(i);
        if (misses_region(g, region)) continue;
        const bool covering = covers_region(g, region);
        if (!covering && polygon_of(region, list_[i]).count == 0) continue;
        present_.push_back(i);
        if (!covering) continue;
        const double z = affine_at(record(list_[i]), X, Y).z;
        if (z < nearest) {
            nearest = z;
            first = &list_[i];
        }
    }
    Acceptable a;
    if (present_.empty()) {
        a.depths = DepthInterval{};
        return a;
    }
    if (first == nullptr) return {};
    const std::uint32_t plane = planes_.plane_of[first->facet];
    const bool any = receivers_ == Receivers::any;
    if (plane == no_plane || (any && set_.facets[first->facet].crossing != Crossing::entry)) return {};

    Bounds bounds;
    for (const std::uint32_t i : present_) {
        const Listed& q = list_[i];
        const Crossing crossing = set_.facets[q.facet].crossing;
        if (planes_.plane_of[q.facet] == plane) {
            // The same surface; to receivers anywhere, one that ends where it begins.
            if (any && crossing != Crossing::entry) return {};
            continue;
        }
        // Facets of a group that covers the region are one plane, which is accounted for once.
        if (covers_region(group_of(i), region) && sets_.parent[i] != i) continue;
        Listed reach = q;
        if (covers_region(group_of(i), region)) {
            reach.crossed = 0;
            reach.low = group_of(i).low;
        }
        if (!account(region, reach, *first, !any || crossing != Crossing::entry, bounds)) return {};
    }
    if (any && !is_closed(region, present_)) return {};

    double most = -1e300;
    for (int i = 0; i < whole.count; ++i) {
        const Corner& c = whole.at[static_cast<std::size_t>(i)];
        const PlaneAt z = affine_at(record(*first), c.X, c.Y);
        most = std::max(most, z.z + slack_of(z.terms));
    }
    const float entry = clamped(record(*first), most);
    const float exit = bounds.behind > 1.0f ? 1.0f : any ? bounds.behind : just_before(bounds.behind);
    if (entry <= exit) a.depths = {entry, exit};
    const auto room = static_cast<float>(bounds.room);
    if (bounds.ramp) {
        take_plane(a, with_ramp(plane, room, bounds.most, std::max(bounds.least, bounds.steepest / 64)));
    } else if (offset_between(least_offset, room)) {
        a.plane = plane;
        a.need = least_offset;
        a.room = room;
    }
    if (a.empty()) return {};
    return a;
}

std::optional<FacetPart> RegionJudge::by_plane() {
    const std::optional<Acceptable> a = judge({square_, nullptr, true});
    if (!a) return {};
    return FacetPart::of(*a);
}

std::optional<FacetPart> RegionJudge::by_edge() {
    // The nearest groups' edges first.
    std::array<const Group*, most_edges> tried{};
    int count = 0;
    for (; count < most_edges; ++count) {
        const Group* next = nullptr;
        for (std::uint32_t i = 0; i < list_.size(); ++i) {
            const Group& g = groups_[i];
            if (sets_.parent[i] != i || g.cover != Group::side) continue;
            const bool known = std::any_of(tried.begin(), tried.begin() + count,
                                           [&](const Group* t) { return t->line.edge == g.line.edge; });
            if (!known && (next == nullptr || g.low < next->low)) next = &g;
        }
        if (next == nullptr) return {};
        tried[static_cast<std::size_t>(count)] = next;
        const FacetEdge edge = next->line.edge;
        const std::optional<Acceptable> low = judge({square_, &edge, false});
        if (!low) continue;
        const std::optional<Acceptable> high = judge({square_, &edge, true});
        if (!high) continue;
        FacetPart part;
        part.value[0] = *low;
        part.value[1] = *high;
        part.has_edge = true;
        part.edge = edge;
        return part;
    }
    return {};
}

}  // namespace obscura
