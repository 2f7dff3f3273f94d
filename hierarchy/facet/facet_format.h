#pragma once
// The words of a tree of the code facet. POD: kernels include this.
//
//   header | nodes, the root first | edges | planes                                         little-endian
//
//   full    header, value        empty   header       leaf   value
//   line    edge, then the values that it has of its own: of the low side, of the high side
//
//   header  bits 0-11: kinds of the four children, three bits each; 12-31: offset to them, in words times the
//           scale of the node's height
//   kinds   000 none  001 leaf  010 empty  011 full  101 line, low side inherited  110 line, high side
//           inherited  111 line, both its own. So a child takes as many words as its kind has bits that are
//           set, but for an edge, which is the third bit's.
//   value   bit 31 clear: a float. Set: bits 0-19 a plane, 20-24 a cap, 25-30 a ramp
//   edge    its number. High side: where a x + b y + c >= 0 for texel (x, y), all of them whole numbers
//   plane   those of the rasterizer (raster/record.h): depth float(a X + (b Y + c)) at texel centres, in
//           [zmin, zmax]
//
// A plane that covers a square is what the light sees there, so a value on it would be the lit surface
// itself. Values lie behind it by an offset: the cap, 2^-(cap + 1), or 0 for cap 31; on a
// leaf with an edge, with a ramp other than 63, no more than 2^-ramp times the distance to it. Surfaces often
// meet at an edge, and the offset has to end where they do.

#include <cstdint>

#include "hierarchy/tree_code.h"

namespace obscura {

struct FacetHeader {
    std::uint32_t nodes = 0;                                               ///< words, padding included
    std::uint32_t first_edge = 0, edges = 0, first_plane = 0, planes = 0;  ///< first: words
    std::uint32_t zero[3] = {};
};
constexpr std::uint32_t facet_header_words = sizeof(FacetHeader) / 4;
static_assert(facet_header_words % 2 == 0);

/// Whole numbers below 2^53: sums and products of them with texels are exact in double.
struct FacetEdge {
    double c = 0;
    std::int32_t a = 0, b = 0;
    friend bool operator==(const FacetEdge&, const FacetEdge&) = default;
};
struct FacetPlane {
    double a = 0, b = 0, c = 0;
    float zmin = 0, zmax = 1;
    friend bool operator==(const FacetPlane&, const FacetPlane&) = default;
};
static_assert(sizeof(FacetEdge) == 16 && sizeof(FacetPlane) == 32);
constexpr std::uint32_t facet_edge_words = 4, facet_plane_words = 8;

/// Kinds of children.
constexpr std::uint32_t facet_leaf = 1, facet_empty = 2, facet_full = 3, facet_line = 4;
constexpr std::uint32_t facet_own_high = 1, facet_own_low = 2;  ///< of lines
constexpr int facet_kind_bits = 12, facet_offset_bits = 20;

/// Words of a value.
constexpr std::uint32_t facet_is_plane = 1u << 31;
constexpr std::uint32_t facet_most_planes = 1u << 20;
constexpr std::uint32_t facet_no_cap = 31, facet_no_ramp = 63;
constexpr std::uint32_t facet_plane_value(std::uint32_t plane, std::uint32_t cap, std::uint32_t ramp) {
    return facet_is_plane | ramp << 25 | cap << 20 | plane;
}
constexpr std::uint32_t facet_plane_of(std::uint32_t value) {
    return value & (facet_most_planes - 1);
}

OBSCURA_TREE_INLINE float facet_power(std::uint32_t minus_exponent) {
    const std::uint32_t bits = (127u - minus_exponent) << 23;
    float power;
    __builtin_memcpy(&power, &bits, sizeof power);
    return power;
}

/// Distance from which ramps begin to rise, in the units of the edge: up to 1/32 of a texel, which is more
/// than vertices move when they snap to the grid.
OBSCURA_TREE_INLINE double facet_ramp_start(const FacetEdge& e) {
    const std::int32_t a = e.a < 0 ? -e.a : e.a, b = e.b < 0 ? -e.b : e.b;
    return static_cast<double>(a > b ? a : b) * (1.0 / 32.0);
}

/// Where there is no edge no ramp counts.
constexpr double facet_far = 0x1p100;

/// Exact.
OBSCURA_TREE_INLINE double facet_distance(const FacetEdge& e, std::int32_t x, std::int32_t y) {
    return static_cast<double>(e.a) * x + (static_cast<double>(e.b) * y + e.c);
}

/// What a plane's value lies behind the plane; `beyond`: distance from the edge, on whichever side, less
/// facet_ramp_start().
OBSCURA_TREE_INLINE float facet_offset(std::uint32_t value, double beyond) {
    const std::uint32_t cap = value >> 20 & 31u, ramp = value >> 25 & 63u;
    const float most = cap == facet_no_cap ? 0.0f : facet_power(cap + 1);
    if (ramp == facet_no_ramp) return most;
    const float rise = static_cast<float>(beyond > 0 ? beyond : 0.0) * facet_power(ramp);
    return rise < most ? rise : most;
}

/// The rasterizer's depth of the plane at the centre of a texel.
OBSCURA_TREE_INLINE float facet_plane_depth(const FacetPlane& p, std::int32_t x, std::int32_t y) {
    const float z = static_cast<float>(p.a * (x + 0.5) + (p.b * (y + 0.5) + p.c));
    const float low = z < p.zmax ? z : p.zmax;
    return low > p.zmin ? low : p.zmin;
}

OBSCURA_TREE_INLINE float facet_behind(float depth, float offset) {
    const float z = depth + offset;
    return z < 1.0f ? z : 1.0f;
}

}  // namespace obscura
