#include "hierarchy/facets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace obscura {
namespace {

struct Point {
    std::int32_t x, y;
};

/// Ends of edge k of an outline, as its record walks it.
struct Segment {
    Point from, to;
};
Segment segment(const FacetSet& set, const Facet& f, int k) {
    const bool second = f.edges == 4 && k >= 2;
    const TriangleRecord& t = set.setup.records[f.record + (second ? 1u : 0u)];
    const int from = second ? k - 2 : k, to = from == 2 ? 0 : from + 1;
    return {{t.x[from], t.y[from]}, {t.x[to], t.y[to]}};
}

/// Bounds of the depth at samples inside the outline. Without rounding, those at its corners; every operation
/// of the depth formula may add half a unit in the last place of its largest term.
void bound_depth(const FacetSet& set, Facet& f) {
    const TriangleRecord& t = set.plane(f);
    double low = std::numeric_limits<double>::infinity(), high = -low, largest = std::fabs(t.c);
    for (int k = 0; k < f.edges; ++k) {
        const Point p = segment(set, f, k).from;
        const double x = static_cast<double>(p.x) / subtexel_one, y = static_cast<double>(p.y) / subtexel_one;
        const double z = t.a * x + (t.b * y + t.c);
        low = std::min(low, z);
        high = std::max(high, z);
        largest = std::max({largest, std::fabs(t.a * x), std::fabs(t.b * y)});
    }
    const double slack = 8.0 * std::numeric_limits<double>::epsilon() * largest;
    // Rounding to float and clamping are monotone: what lies between doubles lies between their floats.
    const auto clamped = [&](double z) { return std::max(std::min(static_cast<float>(z), t.zmax), t.zmin); };
    f.z_low = clamped(low - slack);
    f.z_high = clamped(high + slack);
}

Facet facet_of(const FacetSet& set, std::uint32_t record) {
    const TriangleRecord& t = set.setup.records[record];
    Facet f;
    f.record = record;
    f.crossing = t.crossing;
    f.edges = t.paired ? 4 : 3;
    f.x_low = std::min({t.x[0], t.x[1], t.x[2]});
    f.x_high = std::max({t.x[0], t.x[1], t.x[2]});
    f.y_low = std::min({t.y[0], t.y[1], t.y[2]});
    f.y_high = std::max({t.y[0], t.y[1], t.y[2]});
    if (t.paired) {
        const TriangleRecord& second = set.setup.records[record + 1];
        f.x_low = std::min(f.x_low, second.x[1]);
        f.x_high = std::max(f.x_high, second.x[1]);
        f.y_low = std::min(f.y_low, second.y[1]);
        f.y_high = std::max(f.y_high, second.y[1]);
    }
    bound_depth(set, f);
    return f;
}

/// An edge of an outline, to be matched with the one that walks it the other way.
struct EdgeWalk {
    std::uint64_t low = 0, high = 0;  ///< its ends, the lesser first
    std::uint32_t facet = 0;
    std::uint8_t k = 0, crossing = 0;
    bool forward = false;  ///< walked from low to high

    bool same_edge(const EdgeWalk& e) const {
        return low == e.low && high == e.high && crossing == e.crossing;
    }
    friend bool operator<(const EdgeWalk& p, const EdgeWalk& q) {
        if (p.low != q.low) return p.low < q.low;
        if (p.high != q.high) return p.high < q.high;
        if (p.crossing != q.crossing) return p.crossing < q.crossing;
        return p.facet != q.facet ? p.facet < q.facet : p.k < q.k;
    }
};

std::uint64_t key_of(Point p) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(p.x)) << 32 |
           static_cast<std::uint32_t>(p.y);
}

EdgeWalk walk_of(const FacetSet& set, std::uint32_t facet, int k) {
    const Facet& f = set.facets[facet];
    const Segment s = segment(set, f, k);
    const std::uint64_t from = key_of(s.from), to = key_of(s.to);
    return {std::min(from, to),
            std::max(from, to),
            facet,
            static_cast<std::uint8_t>(k),
            static_cast<std::uint8_t>(f.crossing),
            from < to};
}

/// Pairs the walks of each edge, first forward with first backward and so on.
void match(std::vector<EdgeWalk>& walks, std::vector<Facet>& facets) {
    std::sort(walks.begin(), walks.end());
    std::vector<const EdgeWalk*> waiting;
    for (std::size_t begin = 0; begin < walks.size();) {
        waiting.clear();
        std::size_t end = begin;
        for (; end < walks.size() && walks[end].same_edge(walks[begin]); ++end) {
            const EdgeWalk& e = walks[end];
            const auto other = std::find_if(waiting.begin(), waiting.end(),
                                            [&](const EdgeWalk* w) { return w->forward != e.forward; });
            if (other == waiting.end()) {
                waiting.push_back(&e);
                continue;
            }
            facets[e.facet].neighbour[e.k] = (*other)->facet;
            facets[(*other)->facet].neighbour[(*other)->k] = e.facet;
            waiting.erase(other);
        }
        begin = end;
    }
}

/// Finds every facet's neighbours: edges are dealt into buckets, which are matched one by one.
void find_neighbours(FacetSet& set, const Exec& exec) {
    constexpr std::size_t buckets = 64;
    const auto bucket_of = [](const EdgeWalk& e) {
        const std::uint64_t mixed = (e.low * 0x9e3779b97f4a7c15ull) ^ (e.high * 0xc2b2ae3d27d4eb4full);
        return static_cast<std::size_t>(mixed >> 58);
    };
    std::vector<std::vector<EdgeWalk>> bucket(buckets);
    for (std::uint32_t f = 0; f < set.facets.size(); ++f) {
        for (int k = 0; k < set.facets[f].edges; ++k) {
            const EdgeWalk walk = walk_of(set, f, k);
            bucket[bucket_of(walk)].push_back(walk);
        }
    }
    // Every edge of every facet is in one bucket: their writes are disjoint.
    parallel_for(buckets, exec, [&](std::size_t b) { match(bucket[b], set.facets); });
}

}  // namespace

FacetSet facets_of(const Mesh& mesh, const View& view, bool only_casters, const Exec& exec) {
    FacetSet set;
    SetupParams params;
    params.only_casters = only_casters;
    params.pair_faces = true;
    params.centre_samples_only = false;  // slivers cover nothing, but connect what is on their sides
    setup_triangles(mesh, view, params, exec, set.setup);
    for (const RecordBlock& block : set.setup.blocks) {
        for (std::size_t i = block.begin; i < block.begin + block.count; ++i) {
            if (!set.setup.records[i].second)
                set.facets.push_back(facet_of(set, static_cast<std::uint32_t>(i)));
        }
    }
    find_neighbours(set, exec);
    return set;
}

DepthRange plane_range(const TriangleRecord& plane, std::int32_t x0, std::int32_t x1, std::int32_t y0,
                       std::int32_t y1) {
    const double X0 = x0 + 0.5, X1 = x1 + 0.5, Y0 = y0 + 0.5, Y1 = y1 + 0.5;
    const bool right = plane.a >= 0, down = plane.b >= 0;
    return {depth_at(plane, right ? X0 : X1, down ? Y0 : Y1),
            depth_at(plane, right ? X1 : X0, down ? Y1 : Y0)};
}

std::optional<Listed> place(const FacetSet& set, std::uint32_t index, std::uint32_t crossed,
                            const Square& square) {
    const Facet& f = set.facets[index];
    const std::int32_t left = square.left(), top = square.top(), span = square.span();
    // Samples stand a vanishing step right of and below their centres (see edge_function()).
    if (f.x_high <= left || f.x_low > left + span || f.y_high <= top || f.y_low > top + span) return {};

    Listed listed{index, 0, f.z_low, f.z_high};
    for (int k = 0; k < f.edges; ++k) {
        if ((crossed >> k & 1u) == 0) continue;
        const EdgeFunction e = set.edge(f, k);
        const std::int64_t first = e.at(left, top), dx = e.A * span, dy = e.B * span;
        if (first + std::max<std::int64_t>(dx, 0) + std::max<std::int64_t>(dy, 0) < 0) return {};
        if (first + std::min<std::int64_t>(dx, 0) + std::min<std::int64_t>(dy, 0) < 0)
            listed.crossed |= 1u << k;
    }

    const TriangleRecord& plane = set.plane(f);
    const std::int32_t last_x = square.x0 + square.side - 1, last_y = square.y0 + square.side - 1;
    if (listed.covers_all()) {
        const DepthRange r = plane_range(plane, square.x0, last_x, square.y0, last_y);
        listed.low = r.low;
        listed.high = r.high;
        return listed;
    }
    // Columns and rows of centres inside its box; none: it covers no texel, but may connect others.
    const std::int32_t x0 = std::max((f.x_low - 128 + 255) >> subtexel_bits, square.x0);
    const std::int32_t x1 = std::min((f.x_high - 128) >> subtexel_bits, last_x);
    const std::int32_t y0 = std::max((f.y_low - 128 + 255) >> subtexel_bits, square.y0);
    const std::int32_t y1 = std::min((f.y_high - 128) >> subtexel_bits, last_y);
    if (x0 > x1 || y0 > y1) return listed;
    const DepthRange r = plane_range(plane, x0, x1, y0, y1);
    listed.low = std::max(listed.low, r.low);
    listed.high = std::min(listed.high, r.high);
    return listed;
}

bool edge_meets(const FacetSet& set, const Facet& f, int k, const Square& square) {
    const Segment s = segment(set, f, k);
    const std::int32_t left = square.left(), top = square.top(), span = square.span();
    if (std::max(s.from.x, s.to.x) <= left || std::min(s.from.x, s.to.x) > left + span) return false;
    if (std::max(s.from.y, s.to.y) <= top || std::min(s.from.y, s.to.y) > top + span) return false;
    const EdgeFunction e = set.edge(f, k);
    const std::int64_t first = e.at(left, top), dx = e.A * span, dy = e.B * span;
    const bool some_inside = first + std::max<std::int64_t>(dx, 0) + std::max<std::int64_t>(dy, 0) >= 0;
    const bool some_outside = first + std::min<std::int64_t>(dx, 0) + std::min<std::int64_t>(dy, 0) < 0;
    return some_inside && some_outside;
}

}  // namespace obscura
