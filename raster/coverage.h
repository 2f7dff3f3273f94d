#pragma once
// Exact coverage and the one depth formula, sample by sample: the definition that every kernel must match.
//
// J. Pineda, "A Parallel Algorithm for Polygon Rasterization", SIGGRAPH 1988, for the edge functions. Ours
// are exact: vertices on a 24.8 grid, products in 64 bits, which holds for maps of up to 2^20 x 2^20 texels
// with a guard band of the same size around them (|edge function| < 2^61).

#include <cstdint>

#include "raster/record.h"

namespace obscura {

/// E(x, y) = A x + B y + C over fixed-point map positions; a sample is inside the edge when E >= 0.
struct EdgeFunction {
    std::int64_t A = 0, B = 0, C = 0;
    std::int64_t at(std::int64_t x, std::int64_t y) const { return A * x + B * y + C; }
};

/// Edge k of a record, from corner k to corner k + 1.
///
/// A sample exactly on an edge must belong to one of the two triangles that share it. Think of the sample as
/// moved by (e, e^2) for a vanishing e > 0: it is inside when A > 0, or A = 0 and B > 0 (the top-left rule);
/// otherwise E = 0 must count as outside, which in integers is E - 1 >= 0. The moved sample lies on no edge
/// at all, so fronts and backs of a closed mesh balance at every sample.
inline EdgeFunction edge_function(const TriangleRecord& t, int k) {
    const int n = k == 2 ? 0 : k + 1;
    EdgeFunction e;
    e.A = static_cast<std::int64_t>(t.y[k]) - t.y[n];
    e.B = static_cast<std::int64_t>(t.x[n]) - t.x[k];
    e.C = -(e.A * t.x[k] + e.B * t.y[k]);
    const bool keeps_its_edge = e.A > 0 || (e.A == 0 && e.B > 0);
    if (!keeps_its_edge) --e.C;
    return e;
}

/// Whether the record covers the sample of texel (x, y).
inline bool covers(const TriangleRecord& t, std::int32_t x, std::int32_t y, std::int32_t sample_x = 128,
                   std::int32_t sample_y = 128) {
    const std::int64_t px = static_cast<std::int64_t>(x) * subtexel_one + sample_x;
    const std::int64_t py = static_cast<std::int64_t>(y) * subtexel_one + sample_y;
    return edge_function(t, 0).at(px, py) >= 0 && edge_function(t, 1).at(px, py) >= 0 &&
           edge_function(t, 2).at(px, py) >= 0;
}

/// The same for what stands at `t`: a triangle, or both halves of a pair.
inline bool covers_outline(const TriangleRecord* t, std::int32_t x, std::int32_t y,
                           std::int32_t sample_x = 128, std::int32_t sample_y = 128) {
    return covers(t[0], x, y, sample_x, sample_y) || (t[0].paired && covers(t[1], x, y, sample_x, sample_y));
}

/// Map coordinate of a sample, exact in double.
inline double sample_position(std::int32_t texel, std::int32_t sample) {
    return static_cast<double>(texel) + static_cast<double>(sample) * (1.0 / subtexel_one);
}

/// Depth of the record's plane at map position (X, Y). Monotone in X and in Y: every operation in it is.
inline float depth_at(const TriangleRecord& t, double X, double Y) {
    const float z = static_cast<float>(t.a * X + (t.b * Y + t.c));
    const float low = z < t.zmax ? z : t.zmax;
    return low > t.zmin ? low : t.zmin;
}

}  // namespace obscura
