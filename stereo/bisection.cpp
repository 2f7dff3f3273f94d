#include "stereo/bisection.h"

#include <algorithm>

#include "core/edges.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr std::uint32_t none = UINT32_MAX;
/// Beyond so many triangles at an edge, vertices and edges that could be shared no longer are.
constexpr std::size_t most_compared = 64;

}  // namespace

Bisection::Bisection(const Mesh& mesh, const MapProjection& projection, SurfacePoints surface,
                     TrianglePixels lists)
    : points(std::move(surface.points)),
      triangles(mesh.triangles.size()),
      pixels(std::move(lists.pixels)),
      point_of_vertex(std::move(surface.of_vertex)),
      mesh_(mesh),
      projection_(projection) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        FineTriangle& f = triangles[t];
        for (int k = 0; k < 3; ++k) {
            f.vertex[k] = mesh.triangles[t].v[k];
            f.point[k] = point_of_vertex[f.vertex[k]];
            f.edge[k] = none;
        }
        f.source = t;
        f.first_pixel = lists.first[t];
        f.pixels = lists.first[t + 1] - lists.first[t];
    }
}

double Bisection::longest2(const FineTriangle& t) const {
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
        FineEdge edge;
        edge.lo = t.point[k];
        edge.hi = t.point[(k + 1) % 3];
        measure(edge);
        longest = std::max(longest, edge.length2);
    }
    return longest;
}

/// A floor that begins under the camera reaches a million pixels below the map. Its edges are measured, and
/// cut, where somebody sees them: in the map, and around it by its own size, as halves of halves keep a
/// better shape than what remains between arbitrary cuts.
void Bisection::measure(FineEdge& edge) const {
    const MapPoint &a = points[edge.lo].map, &b = points[edge.hi].map;
    edge.length2 = 0;
    edge.middle = 0.5;
    if (!projection_.in_front(a) || !projection_.in_front(b)) return;
    constexpr double around = 1;
    const double from[2] = {a.column(), a.row()}, way[2] = {b.column() - from[0], b.row() - from[1]};
    const double size[2] = {1.0 * projection_.view.width, 1.0 * projection_.view.height};
    // Liang and Barsky, "A new concept and method for line clipping", 1984.
    double begin = 0, end = 1;
    for (int k = 0; k < 2; ++k) {
        const double low = -around * size[k] - from[k], high = (1 + around) * size[k] - from[k];
        if (way[k] == 0) {
            if (low > 0 || high < 0) end = 0;
            continue;
        }
        begin = std::max(begin, std::min(low / way[k], high / way[k]));
        end = std::min(end, std::max(low / way[k], high / way[k]));
    }
    const double whole2 = way[0] * way[0] + way[1] * way[1];
    if (end > begin) {
        edge.length2 = whole2 * (end - begin) * (end - begin);
        edge.middle = 0.5 * (begin + end);
    } else {
        edge.length2 = whole2 * 1e-30;
    }
}

bool Bisection::crosses_near(const FineTriangle& t) const {
    int ahead = 0;
    for (const std::uint32_t p : t.point)
        ahead += projection_.in_front(points[p].map) ? 1 : 0;
    return ahead == 1 || ahead == 2;
}

// Most scenes have nothing to cut, so edges are found when the first triangle asks for it.
void Bisection::link_edges() {
    linked_ = true;
    const std::vector<Triangle> welded = relabel(mesh_.triangles, point_of_vertex);
    next_use_.assign(3 * triangles.size(), none);
    last_use_.assign(3 * triangles.size(), none);
    const auto uses =
        edge_uses(welded, static_cast<std::uint32_t>(points.size()), all_indices(welded.size()));
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        const std::uint32_t e = add_edge(edge[0].lo, edge[0].hi);
        for (std::size_t i = edge.size(); i-- > 0;)
            link(3 * edge[i].triangle + edge[i].corner, e);
    });
}

std::uint32_t Bisection::add_edge(std::uint32_t p, std::uint32_t q) {
    FineEdge& edge = edges_.emplace_back();
    edge.lo = std::min(p, q);
    edge.hi = std::max(p, q);
    edge.first_use = none;
    measure(edge);
    return static_cast<std::uint32_t>(edges_.size() - 1);
}

void Bisection::link(std::uint32_t use, std::uint32_t edge) {
    triangles[use / 3].edge[use % 3] = edge;
    const std::uint32_t next = edges_[edge].first_use;
    next_use_[use] = next;
    last_use_[use] = none;
    if (next != none) last_use_[next] = use;
    edges_[edge].first_use = use;
}

void Bisection::unlink(std::uint32_t use) {
    const std::uint32_t next = next_use_[use], last = last_use_[use];
    if (next != none) last_use_[next] = last;
    (last != none ? next_use_[last] : edges_[triangles[use / 3].edge[use % 3]].first_use) = next;
}

/// A total order of edges: whatever triangle asks, the same of two is longer, so chains of neighbours end.
bool Bisection::longer(std::uint32_t a, std::uint32_t b) const {
    const FineEdge &p = edges_[a], &q = edges_[b];
    if (p.length2 != q.length2) return p.length2 > q.length2;
    if (p.lo != q.lo) return p.lo < q.lo;
    if (p.hi != q.hi) return p.hi < q.hi;
    return a < b;
}

std::uint32_t Bisection::longest_edge(const FineTriangle& t) const {
    std::uint32_t longest = t.edge[0];
    for (int k = 1; k < 3; ++k) {
        if (longer(t.edge[k], longest)) longest = t.edge[k];
    }
    return longest;
}

void Bisection::cut(std::uint32_t t, std::vector<std::uint32_t>& changed) {
    if (!linked_) link_edges();
    if (triangles[t].edge[0] == none) return;
    if (crosses_near(triangles[t])) {
        for (const std::uint32_t e : triangles[t].edge) {
            const MapPoint &lo = points[edges_[e].lo].map, &hi = points[edges_[e].hi].map;
            // From what is behind to what may be drawn. An end that an earlier cut left on the plane, to
            // rounding, is neither: cut there, an edge becomes a point and itself again, and what lies on
            // its two sides would go on being cut apart.
            const bool rises = !projection_.in_front(lo) && hi.z >= projection_.near_m;
            const bool falls = !projection_.in_front(hi) && lo.z >= projection_.near_m;
            if (!rises && !falls) continue;
            cut_edge(e, (projection_.cut_m() - lo.z) / (hi.z - lo.z), changed);
            return;
        }
        return;
    }
    const std::uint32_t wanted = longest_edge(triangles[t]);
    for (std::uint32_t done = none; done != wanted;) {
        // From neighbour to neighbour over ever longer edges, to one that is the longest of all around it.
        std::uint32_t e = wanted;
        for (std::uint32_t use = edges_[e].first_use; use != none;) {
            const std::uint32_t other = longest_edge(triangles[use / 3]);
            use = other == e ? next_use_[use] : edges_[e = other].first_use;
        }
        // Half way on the screen: weights 1/z in space.
        const double u = edges_[e].middle;
        const double a = u * points[edges_[e].lo].map.z, b = (1.0 - u) * points[edges_[e].hi].map.z;
        cut_edge(e, a > 0 && b > 0 ? a / (a + b) : 0.5, changed);
        done = e;
    }
}

std::uint32_t Bisection::add_point(const FineEdge& edge, double share) {
    const SurfacePoint &a = points[edge.lo], &b = points[edge.hi];
    SurfacePoint mid = a;
    const FineTriangle& user = triangles[edge.first_use / 3];
    if (!mesh_.object.empty()) mid.object = mesh_.object[user.source];
    mid.component = mesh_.component[user.source];
    const Vec3d p = to_double(a.position), q = to_double(b.position);
    mid.position = to_float(p + (q - p) * share);
    mid.map = projection_.project(mid.position);
    // Metres, not pixels, are linear along the edge.
    const double za = (1.0 - share) * a.map.z, zb = share * b.map.z;
    mid.change_px = static_cast<float>(
        (za * static_cast<double>(a.change_px) + zb * static_cast<double>(b.change_px)) / (za + zb));
    mid.seen = false;
    points.push_back(mid);
    return static_cast<std::uint32_t>(points.size() - 1);
}

/// The vertex that is `vertex`, looked for from number `first` on, or a new one: copies that were one on
/// either end are one in the middle.
std::uint32_t Bisection::mid_vertex(const MidVertex& vertex, std::size_t first) {
    std::size_t i = vertices.size() - first < most_compared ? first : vertices.size();
    while (i < vertices.size() && !(vertices[i].a == vertex.a && vertices[i].b == vertex.b))
        ++i;
    if (i == vertices.size()) vertices.push_back(vertex);
    return static_cast<std::uint32_t>(mesh_.positions.size() + i);
}

/// The edge from a new point to the corner across; sheets that lie back to back share it.
std::uint32_t Bisection::edge_across(std::uint32_t opposite, std::uint32_t mid, std::size_t first) {
    std::size_t e = edges_.size() - first < most_compared ? first : edges_.size();
    while (e < edges_.size() && edges_[e].lo != opposite)
        ++e;
    return e < edges_.size() ? static_cast<std::uint32_t>(e) : add_edge(opposite, mid);
}

void Bisection::cut_edge(std::uint32_t e, double share, std::vector<std::uint32_t>& changed) {
    std::vector<std::uint32_t>& uses = scratch_;
    uses.clear();
    for (std::uint32_t use = edges_[e].first_use; use != none; use = next_use_[use])
        uses.push_back(use);
    const std::uint32_t lo = edges_[e].lo, hi = edges_[e].hi;
    const std::uint32_t mid = add_point(edges_[e], share);
    edges_[e].first_use = none;
    const std::uint32_t to_lo = add_edge(lo, mid), to_hi = add_edge(mid, hi);
    const std::size_t first_vertex = vertices.size(), first_edge = edges_.size();
    next_use_.resize(next_use_.size() + 3 * uses.size());
    last_use_.resize(next_use_.size());
    for (const std::uint32_t use : uses) {
        const std::uint32_t t = use / 3;
        const int i = static_cast<int>(use % 3), j = (i + 1) % 3, o = (i + 2) % 3;
        const auto added = static_cast<std::uint32_t>(triangles.size());
        triangles.push_back(triangles[t]);
        FineTriangle &kept = triangles[t], &other = triangles[added];
        const bool forward = kept.point[i] == lo;

        const std::uint32_t a = kept.vertex[forward ? i : j], b = kept.vertex[forward ? j : i];
        const std::uint32_t vertex = mid_vertex({a, b, mid, static_cast<float>(share)}, first_vertex);
        const std::uint32_t across = edge_across(kept.point[o], mid, first_edge);

        // Corner i stays with the one, corner j goes with the other; each edge keeps the number of its
        // corner.
        unlink(3 * t + static_cast<std::uint32_t>(j));
        const std::uint32_t far_edge = kept.edge[j];
        kept.point[j] = other.point[i] = mid;
        kept.vertex[j] = other.vertex[i] = vertex;
        kept.cuts = other.cuts = kept.cuts + 1;
        link(3 * t + static_cast<std::uint32_t>(i), forward ? to_lo : to_hi);
        link(3 * t + static_cast<std::uint32_t>(j), across);
        link(3 * added + static_cast<std::uint32_t>(i), forward ? to_hi : to_lo);
        link(3 * added + static_cast<std::uint32_t>(j), far_edge);
        link(3 * added + static_cast<std::uint32_t>(o), across);
        share_pixels(kept, other, i);
        changed.push_back(t);
        changed.push_back(added);
    }
}

/// Pixels on the side of the corner that `kept` keeps stay with it.
void Bisection::share_pixels(FineTriangle& kept, FineTriangle& added, int from_corner) {
    if (kept.pixels == 0) return;
    const MapPoint& from = points[kept.point[from_corner]].map;
    const MapPoint& m = points[kept.point[(from_corner + 1) % 3]].map;
    const MapPoint& o = points[kept.point[(from_corner + 2) % 3]].map;
    const double a = m.yz * o.z - m.z * o.yz, b = m.z * o.xz - m.xz * o.z, c = m.xz * o.yz - m.yz * o.xz;
    const bool positive = a * from.xz + b * from.yz + c * from.z > 0;
    const auto width = static_cast<std::uint32_t>(projection_.view.width);
    const auto begin = pixels.begin() + kept.first_pixel, end = begin + kept.pixels;
    const auto middle = std::stable_partition(begin, end, [&](std::uint32_t pixel) {
        const std::uint32_t column = pixel % width, row = pixel / width;
        const double x = column + 0.5, y = row + 0.5;
        return (a * x + b * y + c > 0) == positive;
    });
    const auto stay = static_cast<std::uint32_t>(middle - begin);
    added.first_pixel = kept.first_pixel + stay;
    added.pixels = kept.pixels - stay;
    kept.pixels = stay;
}

}  // namespace obscura
