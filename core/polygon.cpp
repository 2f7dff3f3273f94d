// Ear clipping after G. H. Meisters, Polygons have ears, American Mathematical Monthly 82 (1975), with the
// bookkeeping of D. Eberly, Triangulation by ear clipping (2002): only corners that turn right or go straight
// can lie in an ear, and a corner needs a new look only when it lost a neighbour.
#include "core/polygon.h"

#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

/// Twice the signed area of (a, b, c). Differences of single-precision coordinates are exact in double unless
/// their exponents lie far apart; one rounding per product is left.
double turn(Vec2d a, Vec2d b, Vec2d c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners seen along the axis that shows the largest area, counter-clockwise.
std::vector<Vec2d> flatten(std::span<const Vec3f> corners) {
    Vec3d area;  // Newell's normal, from the first corner to keep digits
    const Vec3d origin = to_double(corners[0]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        area = area +
               cross(to_double(corners[i]) - origin, to_double(corners[(i + 1) % corners.size()]) - origin);
    }
    const double x = std::fabs(area.x), y = std::fabs(area.y), z = std::fabs(area.z);
    std::vector<Vec2d> flat;
    flat.reserve(corners.size());
    for (const Vec3f& corner : corners) {
        const Vec3d p = to_double(corner);
        if (z >= x && z >= y) {
            flat.push_back(area.z >= 0 ? Vec2d{p.x, p.y} : Vec2d{p.y, p.x});
        } else if (x >= y) {
            flat.push_back(area.x >= 0 ? Vec2d{p.y, p.z} : Vec2d{p.z, p.y});
        } else {
            flat.push_back(area.y >= 0 ? Vec2d{p.z, p.x} : Vec2d{p.x, p.z});
        }
    }
    return flat;
}

/// The outline that is left, as a ring of corner numbers.
struct Ring {
    explicit Ring(std::vector<Vec2d> points) : p(std::move(points)), next(p.size()), previous(p.size()) {
        const auto n = static_cast<std::uint32_t>(p.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            next[i] = (i + 1) % n;
            previous[i] = (i + n - 1) % n;
        }
        for (std::uint32_t i = 0; i < n; ++i) {
            if (!convex(i)) reflex.push_back(i);
        }
    }

    bool convex(std::uint32_t i) const { return turn(p[previous[i]], p[i], p[next[i]]) > 0; }

    /// A convex corner whose triangle holds no other corner, not even on its border.
    bool is_ear(std::uint32_t i) const {
        if (!convex(i)) return false;
        const std::uint32_t a = previous[i], c = next[i];
        for (const std::uint32_t r : reflex) {
            const Vec2d q = p[r];
            if (q == p[a] || q == p[i] || q == p[c]) continue;  // the other side of a bridge
            if (turn(p[a], p[i], q) >= 0 && turn(p[i], p[c], q) >= 0 && turn(p[c], p[a], q) >= 0)
                return false;
        }
        return true;
    }

    void clip(std::uint32_t i) {
        next[previous[i]] = next[i];
        previous[next[i]] = previous[i];
        // The clipped corner is no obstacle any more; its neighbours may have turned convex, or straight.
        std::size_t kept = 0;
        for (const std::uint32_t r : reflex) {
            if (r != i && r != previous[i] && r != next[i]) reflex[kept++] = r;
        }
        reflex.resize(kept);
        for (const std::uint32_t k : {previous[i], next[i]}) {
            if (!convex(k)) reflex.push_back(k);
        }
    }

    std::vector<Vec2d> p;
    std::vector<std::uint32_t> next, previous;
    std::vector<std::uint32_t> reflex;  ///< corners that are not strictly convex
};

/// How often all corners may be looked at anew; only outlines that cross themselves use it up.
constexpr int most_rounds = 64;

/// No ear anywhere: the outline crosses itself or has no area. Any convex corner will do.
std::uint32_t least_harm(const Ring& ring, std::uint32_t start) {
    std::uint32_t i = start;
    do {
        if (ring.convex(i)) return i;
        i = ring.next[i];
    } while (i != start);
    return start;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(std::span<const Vec3f> corners) {
    CHECK(corners.size() >= 3 && corners.size() < UINT32_MAX);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.reserve(corners.size() - 2);
    if (corners.size() == 3) return {{0, 1, 2}};

    Ring ring(flatten(corners));
    std::vector<bool> blocked(corners.size(), false);  // was no ear when last looked at
    std::size_t left = corners.size(), misses = 0;
    bool looked_anew = true;
    int rounds = 0;
    std::uint32_t at = 1;
    while (left > 3) {
        if (misses < left && (blocked[at] || !ring.is_ear(at))) {
            blocked[at] = true;
            at = ring.next[at];
            ++misses;
            continue;
        }
        // Clipping elsewhere can free a corner. That is rare, so all are looked at anew only when none is
        // left.
        if (misses == left && !looked_anew && rounds < most_rounds) {
            blocked.assign(blocked.size(), false);
            misses = 0;
            looked_anew = true;
            ++rounds;
            continue;
        }
        const std::uint32_t ear = misses < left ? at : least_harm(ring, at);
        triangles.push_back({ring.previous[ear], ear, ring.next[ear]});
        ring.clip(ear);
        blocked[ring.previous[ear]] = blocked[ring.next[ear]] = false;
        // Step over the neighbour: fans of slivers around one corner are the last resort.
        at = ring.next[ring.next[ear]];
        misses = 0;
        looked_anew = false;
        --left;
    }
    triangles.push_back({ring.previous[at], at, ring.next[at]});
    return triangles;
}

}  // namespace obscura
