#pragma once
// An independent, slow and obvious rasterizer for tests: exact integers of 128 bits, one sample at a time, no
// tiles. It shares no code with raster/ but the record of a triangle and the formula of depth.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/types.h"
#include "raster/record.h"

namespace obscura::oracle {

using Wide = __int128;

/// -1, 0, 1.
inline int sign(Wide v) {
    return v > 0 ? 1 : (v < 0 ? -1 : 0);
}

/// On which side of the line p -> q lies the sample moved by (e, e^2), e > 0 vanishing: never 0 unless p = q.
/// The first of the powers 1, e, e^2 with a non-zero coefficient decides.
inline int side(std::int64_t px, std::int64_t py, std::int64_t qx, std::int64_t qy, std::int64_t sx,
                std::int64_t sy) {
    const Wide dx = qx - px, dy = qy - py;
    if (const int s = sign(dx * (sy - py) - dy * (sx - px)); s != 0) return s;
    if (const int s = sign(-dy); s != 0) return s;
    return sign(dx);
}

/// Whether the moved sample lies inside the triangle, whichever way it turns: all three sides agree.
inline bool covers(const std::int32_t (&x)[3], const std::int32_t (&y)[3], std::int64_t sx, std::int64_t sy) {
    const int a = side(x[0], y[0], x[1], y[1], sx, sy);
    const int b = side(x[1], y[1], x[2], y[2], sx, sy);
    const int c = side(x[2], y[2], x[0], y[0], sx, sy);
    return a != 0 && a == b && b == c;
}

/// The depth formula, written out once more.
inline float depth(const TriangleRecord& t, double X, double Y) {
    const double bYc = t.b * Y + t.c;
    const double z = t.a * X + bYc;
    return std::max(std::min(static_cast<float>(z), t.zmax), t.zmin);
}

struct Hit {
    float depth;
    int kind;  ///< 0 entry, 1 open, 2 exit
    std::uint32_t triangle;
};

/// All hits at the centre of texel (x, y), in order.
inline std::vector<Hit> hits_at(const std::vector<TriangleRecord>& records, int x, int y) {
    std::vector<Hit> hits;
    for (const TriangleRecord& t : records) {
        if (!covers(t.x, t.y, std::int64_t{x} * 256 + 128, std::int64_t{y} * 256 + 128)) continue;
        hits.push_back({depth(t, x + 0.5, y + 0.5), static_cast<int>(t.crossing), t.triangle});
    }
    std::sort(hits.begin(), hits.end(), [](const Hit& p, const Hit& q) {
        if (p.depth != q.depth) return p.depth < q.depth;
        return p.kind != q.kind ? p.kind < q.kind : p.triangle < q.triangle;
    });
    return hits;
}

/// The policy of raster/intervals.h, told once more over prefix sums of the counter.
inline DepthInterval interval(const std::vector<Hit>& hits, bool static_receivers) {
    if (hits.empty()) return {1.0f, 1.0f};
    const Hit& first = hits.front();
    if (static_receivers) {
        float next = 2.0f;
        for (const Hit& h : hits)
            next = h.depth == first.depth ? next : std::min(next, h.depth);
        return {first.depth, next == 2.0f ? 1.0f : __builtin_nextafterf(next, -1.0f)};
    }
    if (first.kind != 0) return {first.depth, first.depth};
    int sum = 0;
    for (const Hit& h : hits) {
        sum += h.kind == 0 ? 1 : (h.kind == 2 ? -1 : 0);
        if (sum == 0) return {first.depth, h.depth};
    }
    return {first.depth, first.depth};
}

}  // namespace obscura::oracle
