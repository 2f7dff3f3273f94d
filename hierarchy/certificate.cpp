#include "hierarchy/certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "raster/intervals.h"

namespace obscura {
namespace {

float ulp(float z) {
    return std::nextafterf(z, 2.0f) - z;
}

bool same_plane(const TriangleRecord& s, const TriangleRecord& t) {
    return std::tie(s.a, s.b, s.c, s.zmin, s.zmax) == std::tie(t.a, t.b, t.c, t.zmin, t.zmax);
}

/// The four corner texels' centres.
struct Corners {
    double X[2], Y[2];
    explicit Corners(const Square& s)
        : X{s.x0 + 0.5, s.x0 + s.side - 0.5}, Y{s.y0 + 0.5, s.y0 + s.side - 0.5} {}
};

}  // namespace

Verdict Judge::judge(const Square& square, std::vector<Listed>& list, std::size_t begin) {
    const std::span<Listed> own(list.data() + begin, list.size() - begin);
    connect(square, own);
    gather(square, own);
    const Course found = course(square);

    Verdict verdict;
    verdict.common = common(found, square, own);
    verdict.uniform = verdict.common && is_uniform(found);
    verdict.by_mesh = verdict.common && found.kind != Course::nothing && takes_meshes(found);
    verdict.deepest = found.kind == Course::uncertain ? exit_bound() : found.deepest;
    list.erase(std::remove_if(list.begin() + static_cast<std::ptrdiff_t>(begin), list.end(),
                              [](const Listed& l) { return l.facet == no_facet; }),
               list.end());
    return verdict;
}

/// Whether a surface of several facets decides.
bool Judge::takes_meshes(const Course& c) const {
    if (c.first.plane == nullptr || (c.kind == Course::solid && c.last.plane == nullptr)) return true;
    return std::any_of(layers_.begin() + static_cast<std::ptrdiff_t>(c.next_begin),
                       layers_.begin() + static_cast<std::ptrdiff_t>(c.next_end),
                       [](const Layer& l) { return l.plane == nullptr; });
}

/// Whether all that decides an interval, where common() is not empty, has the same depth everywhere.
bool Judge::is_uniform(const Course& c) const {
    const auto level = [](const Layer& l) { return l.low == l.high; };
    if (c.kind == Course::nothing || c.kind == Course::point) return true;
    if (c.kind == Course::solid) return level(c.first) && level(c.last);
    return level(c.first) && std::all_of(layers_.begin() + static_cast<std::ptrdiff_t>(c.next_begin),
                                         layers_.begin() + static_cast<std::ptrdiff_t>(c.next_end), level);
}

/// Joins facets that share an edge within the square. What is left is torn where an edge has nothing beyond
/// it.
void Judge::connect(const Square& square, std::span<const Listed> list) {
    const auto count = static_cast<std::uint32_t>(list.size());
    surfaces_.reset(count);
    groups_.assign(count, {});
    for (std::uint32_t i = 0; i < count; ++i)
        slot_[list[i].facet] = i;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (list[i].covers_all()) continue;
        if (count > longest_surface_) {
            groups_[i].torn = true;
            continue;
        }
        const Facet& f = set_.facets[list[i].facet];
        for (int k = 0; k < f.edges; ++k) {
            if ((list[i].crossed >> k & 1u) == 0 || !edge_meets(set_, f, k, square)) continue;
            const std::uint32_t other = f.neighbour[k];
            const std::uint32_t j = other == no_facet ? count : slot_[other];
            if (j < count && list[j].facet == other && !list[j].covers_all()) {
                surfaces_.unite(i, j);
            } else {
                groups_[i].torn = true;
            }
        }
    }
}

bool Judge::covers_first_texel(const Listed& l, const Square& square) const {
    const Facet& f = set_.facets[l.facet];
    for (int k = 0; k < f.edges; ++k) {
        if ((l.crossed >> k & 1u) != 0 && set_.edge(f, k).at(square.left(), square.top()) < 0) return false;
    }
    return true;
}

void Judge::add_to(Group& g, const Listed& l, const Square& square) const {
    const TriangleRecord& plane = set_.plane(set_.facets[l.facet]);
    if (g.plane == nullptr) g.plane = &plane;
    g.one_plane = g.one_plane && same_plane(*g.plane, plane);
    g.low = std::min(g.low, l.low);
    g.high = std::max(g.high, l.high);
    g.weight += covers_first_texel(l, square);
}

Layer Judge::layer_of(const Group& g, std::uint32_t root, const Square& square, const Listed& member) const {
    Layer layer{set_.facets[member.facet].crossing, g.weight, g.low, g.high, nullptr, root};
    if (g.one_plane && g.weight == 1) {
        const std::int32_t last_x = square.x0 + square.side - 1, last_y = square.y0 + square.side - 1;
        const DepthRange r = plane_range(*g.plane, square.x0, last_x, square.y0, last_y);
        layer.low = r.low;
        layer.high = r.high;
        layer.plane = g.plane;
    }
    return layer;
}

/// Sorts what is listed into layers, which cover every texel equally often, and the uncertain rest. Groups
/// that cover no texel leave the list.
void Judge::gather(const Square& square, std::span<Listed> list) {
    layers_.clear();
    uncertain_entries_.clear();
    least_uncertain_ = 2.0f;
    // A tear is its whole group's; what is in a torn group need not be looked at more closely.
    for (std::uint32_t i = 0; i < list.size(); ++i) {
        if (list[i].covers_all()) continue;
        const std::uint32_t root = surfaces_.parent[i] = surfaces_.root(i);
        groups_[root].torn = groups_[root].torn || groups_[i].torn;
    }
    for (std::uint32_t i = 0; i < list.size(); ++i) {
        const Listed& l = list[i];
        const Facet& f = set_.facets[l.facet];
        if (l.covers_all()) {
            layers_.push_back({f.crossing, 1, l.low, l.high, &set_.plane(f), i});
        } else if (Group& g = groups_[surfaces_.parent[i]]; g.torn) {
            least_uncertain_ = std::min(least_uncertain_, l.low);
            if (f.crossing == Crossing::entry) uncertain_entries_.push_back(l.low);
        } else {
            add_to(g, l, square);
        }
    }
    for (std::uint32_t i = 0; i < list.size(); ++i) {
        if (list[i].covers_all()) continue;
        const Group& g = groups_[surfaces_.parent[i]];
        if (g.torn) continue;
        if (surfaces_.parent[i] == i && g.weight > 0) layers_.push_back(layer_of(g, i, square, list[i]));
        if (g.weight == 0) list[i].facet = no_facet;
    }
    std::sort(layers_.begin(), layers_.end(), [](const Layer& p, const Layer& q) {
        return std::tie(p.low, p.crossing, p.root) < std::tie(q.low, q.crossing, q.root);
    });
}

/// Whether p lies before q at every texel, strictly or, with `or_equal`, nowhere behind it. The distance of
/// two planes is affine: what it exceeds at the corners it exceeds everywhere between. Rounding to float
/// keeps the order of depths but may make them equal, which the margin excludes.
bool Judge::certainly_before(const Layer& p, const Layer& q, const Square& square, bool or_equal) const {
    if (p.high < q.low || (or_equal && p.high <= q.low)) return true;
    if (p.plane == nullptr || q.plane == nullptr) return false;
    const Corners at(square);
    const TriangleRecord &s = *p.plane, &t = *q.plane;
    const bool same = s.a == t.a && s.b == t.b && s.c == t.c;
    if (same && !or_equal) return false;
    const double margin = or_equal ? 0.0 : static_cast<double>(ulp(std::max(p.high, q.high)));
    for (const double X : at.X) {
        for (const double Y : at.Y) {
            const double zs = s.a * X + (s.b * Y + s.c), zt = t.a * X + (t.b * Y + t.c);
            // Clamped depths are not affine.
            const float fs = static_cast<float>(zs), ft = static_cast<float>(zt);
            if (fs < s.zmin || fs > s.zmax || ft < t.zmin || ft > t.zmax) return false;
            const double terms = std::fabs(s.a * X) + std::fabs(s.b * Y) + std::fabs(s.c) +
                                 std::fabs(t.a * X) + std::fabs(t.b * Y) + std::fabs(t.c);
            if (!same && !(zt - zs > margin + 8.0 * std::numeric_limits<double>::epsilon() * terms))
                return false;
        }
    }
    return true;
}

/// Layers whose depths overlap: orders them where planes allow it.
bool Judge::put_in_order(std::span<Layer> cluster, const Square& square) const {
    const Corners at(square);
    for (const Layer& l : cluster) {
        if (l.plane == nullptr) return false;
    }
    std::sort(cluster.begin(), cluster.end(), [&](const Layer& p, const Layer& q) {
        const float zp = depth_at(*p.plane, at.X[0], at.Y[0]), zq = depth_at(*q.plane, at.X[0], at.Y[0]);
        return std::tie(zp, p.crossing, p.root) < std::tie(zq, q.crossing, q.root);
    });
    for (std::size_t i = 1; i < cluster.size(); ++i) {
        // Equal, an exit and an entry would change places.
        const bool or_equal = cluster[i - 1].crossing <= cluster[i].crossing;
        if (!certainly_before(cluster[i - 1], cluster[i], square, or_equal)) return false;
    }
    return true;
}

Judge::Course Judge::course(const Square& square) {
    if (layers_.empty() && least_uncertain_ > 1.0f) {
        Course c;
        c.kind = Course::nothing;
        return c;
    }
    return receivers_ == Receivers::static_only ? up_to_next(square) : counted(square);
}

/// Receivers::static_only: which layer comes first everywhere, and which come next.
Judge::Course Judge::up_to_next(const Square& square) {
    if (layers_.empty()) return {};
    // Layers whose depths overlap that of the first.
    std::size_t end = 0;
    for (float reach = layers_[0].high; end < layers_.size() && layers_[end].low <= reach; ++end)
        reach = std::max(reach, layers_[end].high);
    if (end > 1 && !put_in_order({layers_.data(), end}, square)) return {};
    Course c;
    c.first = layers_[0];
    if (least_uncertain_ <= c.first.high) return {};
    c.kind = Course::open;
    c.exact = c.first.weight == 1;
    // Coincident sheets are one surface.
    std::size_t next = 1;
    // (In order they all have planes: put_in_order() saw to it.)
    while (next < end && same_plane(*c.first.plane, *layers_[next].plane))
        ++next;
    if (next == layers_.size()) {
        c.exact = c.exact && least_uncertain_ > 1.0f;
        return c;
    }
    c.deepest = layers_[next].high;
    c.exact = c.exact && least_uncertain_ > c.deepest;
    c.next_begin = next;
    for (; next < layers_.size() && layers_[next].low <= c.deepest; ++next)
        c.exact = c.exact && certainly_before(c.first, layers_[next], square, false);
    c.next_end = next;
    if (!certainly_before(c.first, layers_[c.next_begin], square, false)) c.deepest = 2.0f;
    return c;
}

/// Receivers::any: runs the counter of raster/intervals.h once for all texels.
Judge::Course Judge::counted(const Square& square) {
    Course c;
    int inside = 0;
    for (std::size_t i = 0; i < layers_.size();) {
        // Layers whose depths overlap, and their counts.
        std::size_t end = i;
        float reach = layers_[i].high;
        int entries = 0, exits = 0;
        for (; end < layers_.size() && layers_[end].low <= reach; ++end) {
            reach = std::max(reach, layers_[end].high);
            entries += layers_[end].crossing == Crossing::entry ? layers_[end].weight : 0;
            exits += layers_[end].crossing == Crossing::exit ? layers_[end].weight : 0;
        }
        if (least_uncertain_ <= reach) return {};
        const std::size_t begin = i;
        i = end;
        if (inside > exits) {
            inside += entries - exits;  // in whatever order, the counter stays above zero
            continue;
        }
        const std::span<Layer> cluster(layers_.data() + begin, end - begin);
        if (cluster.size() > 1 && !put_in_order(cluster, square)) return {};
        for (std::size_t k = begin; k < end; ++k) {
            const Layer& layer = layers_[k];
            if (inside == 0) {
                c.first = layer;
                c.exact = layer.weight == 1;
                if (layer.crossing != Crossing::entry) {
                    c.kind = Course::point;
                    c.deepest = layer.high;
                    return c;
                }
            }
            if (layer.crossing == Crossing::entry) inside += layer.weight;
            if (layer.crossing == Crossing::exit && (inside -= layer.weight) <= 0) {
                c.kind = Course::solid;
                c.last = layer;
                c.deepest = layer.high;
                c.exact = c.exact && layer.weight == 1;
                return c;
            }
        }
    }
    // Nothing more comes: where the counter is not back at zero, the interval has no width. That is known
    // only at the end of the list, so nothing may be dropped.
    if (least_uncertain_ <= 1.0f) return {};
    c.kind = layers_.empty() ? Course::nothing : Course::point;
    return c;
}

/// A depth by which every texel's interval is decided, though their order is not certain. Beyond a back face
/// that covers all texels, at depth z, that is so when not more front faces may lie before z at any texel
/// than back faces certainly do: the counter has then come back to zero.
float Judge::exit_bound() const {
    float bound = 2.0f;
    if (receivers_ == Receivers::static_only) {
        // Two surfaces that are certainly apart.
        float first = 2.0f;
        for (const Layer& l : layers_)
            first = std::min(first, l.high);
        for (const Layer& l : layers_) {
            if (l.low > first) bound = std::min(bound, l.high);
        }
        return bound;
    }
    for (const Layer& candidate : layers_) {
        if (candidate.crossing == Crossing::entry || candidate.high >= bound) continue;
        const float z = candidate.high;
        int surplus = 0;
        for (const Layer& l : layers_) {
            if (l.crossing == Crossing::entry && l.low <= z) surplus += l.weight;
            if (l.crossing == Crossing::exit && l.high <= z) surplus -= l.weight;
        }
        for (const float low : uncertain_entries_)
            surplus += low <= z;
        if (candidate.crossing == Crossing::exit) {
            if (surplus <= 0) bound = z;
            continue;
        }
        // An open surface ends an interval only where no front face comes before it, and back faces before it
        // do the same.
        const bool first =
            std::none_of(layers_.begin(), layers_.end(),
                         [&](const Layer& l) { return l.crossing == Crossing::entry && l.low <= z; }) &&
            std::none_of(uncertain_entries_.begin(), uncertain_entries_.end(),
                         [&](float low) { return low <= z; });
        if (first) bound = z;
    }
    return bound;
}

std::optional<DepthInterval> Judge::common(const Course& c, const Square& square,
                                           std::span<const Listed> list) const {
    if (c.kind == Course::nothing) return DepthInterval{};
    if (c.kind == Course::uncertain || !c.exact) return {};
    const auto greatest = [&](const Layer& l) { return l.plane ? l.high : extreme(l, square, list, true); };
    const auto least = [&](const Layer& l) { return l.plane ? l.low : extreme(l, square, list, false); };
    if (c.kind == Course::point) {
        if (c.first.low < c.first.high) return {};
        return DepthInterval{c.first.low, c.first.low};
    }
    if (c.kind == Course::open) {
        float next = 2.0f;
        for (std::size_t k = c.next_begin; k < c.next_end; ++k) {
            if (!(c.first.high < layers_[k].low)) return {};
            next = std::min(next, least(layers_[k]));
        }
        return DepthInterval{greatest(c.first), next > 1.0f ? 1.0f : just_before(next)};
    }
    if (!(c.first.high <= c.last.low)) return {};
    return DepthInterval{greatest(c.first), least(c.last)};
}

/// Extreme depth of a layer of several facets: facet by facet, leaving out those whose bounds cannot beat
/// what was found; the most promising first.
float Judge::extreme(const Layer& layer, const Square& square, std::span<const Listed> list,
                     bool greatest) const {
    const auto bound = [&](const Listed& l) { return greatest ? l.high : -l.low; };
    std::vector<const Listed*> own;
    for (std::uint32_t i = 0; i < list.size(); ++i) {
        if (list[i].facet != no_facet && surfaces_.parent[i] == layer.root) own.push_back(&list[i]);
    }
    const auto first = std::max_element(
        own.begin(), own.end(), [&](const Listed* p, const Listed* q) { return bound(*p) < bound(*q); });
    std::iter_swap(own.begin(), first);
    float best = greatest ? -1.0f : 2.0f;
    for (const Listed* l : own) {
        if (bound(*l) <= (greatest ? best : -best)) continue;
        best = extreme_depth(set_, set_.facets[l->facet], square, greatest, best);
    }
    return best;
}

}  // namespace obscura
