#pragma once
// What a triangle is to the sample loops, and the rectangle of texels they work on. POD: kernels include
// this.

#include <cstdint>

namespace obscura {

/// Sub-texel bits of the fixed-point grid that vertices snap to.
constexpr int subtexel_bits = 8;
constexpr std::int32_t subtexel_one = 1 << subtexel_bits;

/// How a ray from the viewer meets a triangle. The order is the order of crossings at equal depth: entries
/// come before exits, so touching solids merge, and a sheet lying on a solid's face counts as part of the
/// solid.
enum class Crossing : std::uint8_t { entry = 0, open = 1, exit = 2 };

/// One triangle (or a piece of one that was clipped) in map space: 64 bytes, one cache line.
///
/// Two triangles of one planar face that make up a convex quadrilateral may stand as a pair, one after the
/// other: corners 0 and 2 of the first are corners 2 and 0 of the second, so the outline is edges 0 and 1 of
/// both. Loops that need not tell the two apart take them as one.
struct TriangleRecord {
    std::int32_t x[3],
        y[3];        ///< fixed point, `subtexel_bits`; turned so that the edge functions are positive inside
    double a, b, c;  ///< depth at map position (X, Y): float(a X + (b Y + c)), clamped to [zmin, zmax]
    float zmin, zmax;        ///< depth range of the whole planar face
    std::uint32_t triangle;  ///< index into the mesh
    Crossing crossing;
    bool paired = false;  ///< the next record is the other half of the quadrilateral
    bool second = false;  ///< this is that other half
    std::uint8_t unused = 0;
};
static_assert(sizeof(TriangleRecord) == 64);

/// Texels [x0, x0 + width) x [y0, y0 + height), each sampled at (sample_x, sample_y) / 256 from its corner.
struct TileRect {
    std::int32_t x0 = 0, y0 = 0;
    std::int32_t width = 0, height = 0;  ///< width: a multiple of 16
    std::int32_t sample_x = 128, sample_y = 128;
};

}  // namespace obscura
