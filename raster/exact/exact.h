#pragma once
// Shadows of a picture's own samples, without a map. POD: kernels include this.
//
// T. Aila and S. Laine, "Alias-Free Shadow Maps", EGSR 2004; G. Johnson, J. Lee, C. Burns, W. Mark, "The
// Irregular Z-Buffer", ACM TOG 2005; C. Wyman, R. Hoetzlein, A. Lefohn, "Frustum-Traced Raster Shadows", I3D
// 2015: what casts shadows is rasterized as the light sees it, not onto texels, but onto the very points that
// the camera sees. No resolution, no filter, no bias to choose.
//
// A triangle darkens a sample when
//   1. it covers the sample as the light sees both: exact edge functions on a grid of 2^28 steps over the
//      view (raster/coverage.h), so that a closed mesh has no cracks;
//   2. the sample lies behind the triangle's plane by more than what is uncertain of its own place, and
//      is not nearer to the light than the triangle's nearest corner;
//   3. it is not of the sample's own planar face.
//
// What is uncertain of a sample. Its position is put back onto its face's plane in doubles, but that it is
// this face which the camera sees hung on depths that are floats. Depths grow in proportion to the eye's
// height above parallel planes, so planes nearer to each other than 2^-23 of that height may have one depth:
// they are one surface for the camera, and so they are here. And its place on the light's grid is a step off.
// Touching solids, sheets back to back, doubled faces and planes that fight for one pixel shade nothing of
// each other.
//
// The camera sees triangles whose corners are snapped to 1/256 pixel, so a sample may lie that far beside the
// triangle it shows, on its plane, and there behind another that meets it. What lies outside of its own
// triangle, and behind a plane of which camera and light see the same side no farther than 1/256 pixel along
// its own plane takes it, lies in front of it, for the camera sees it there. (Of planes between the camera
// and the light nothing of the kind is known: no light gets into a closed room along its edges.)

#include <cstddef>
#include <cstdint>

#include "raster/record.h"

namespace obscura {

/// Texels a side of the views that casters are set up for: with raster/record.h's sub-texel bits a grid of
/// 2^28 steps.
constexpr int exact_view_texels = 1 << 20;

/// Of the eye's height above a plane (orthographic: of |x| + |y| + |z| from the eye): how far apart planes
/// are that one depth of the camera may mean.
constexpr float exact_depth_error = 0x1p-23f;

/// Planes that the camera sees at a smaller cosine are taken as if at this.
constexpr float exact_least_cosine = 1.0f / 16.0f;

/// One triangle that casts a shadow (or a piece of one that was clipped): 64 bytes, one cache line.
struct CasterTriangle {
    double n[3], d;  ///< plane n . p + d of its face, world space, unit, positive on the light's side
    std::int32_t x[3], y[3];  ///< as TriangleRecord: the edge functions are positive inside
    std::uint32_t face;       ///< Mesh::face
    std::uint32_t triangle;   ///< index into the mesh
};
static_assert(sizeof(CasterTriangle) == 64);

/// What bounds sixteen triangles, or sixteen groups of sixteen: on the light's grid, and in depth.
/// Places that hold nothing have x_low > x_high.
struct alignas(64) CasterBoxes {
    std::int32_t x_low[16], x_high[16], y_low[16], y_high[16];
    float z_low[16], z_high[16];
};

/// Enough for 2^32 triangles.
constexpr int most_caster_levels = 8;

/// One view of a light, ready for kernels. Child k of box group i of level l > 0 is group 16 i + k of level
/// l - 1; of level 0, triangle 16 i + k. The last level is a single group.
struct ExactView {
    double to_map[4][4];  ///< LightView::to_map
    const CasterTriangle* triangles = nullptr;
    const CasterBoxes* boxes[most_caster_levels] = {};
    std::int64_t count = 0;   ///< of triangles
    std::int32_t levels = 0;  ///< 0: nothing casts a shadow here
    std::int32_t steps = 0;   ///< of the grid, a side; what lies beyond is lit
    bool perspective = false;
    double near_w = 0;   ///< perspective: samples nearer than this are lit
    double step_m = 0;   ///< metres that a step spans: everywhere, or at distance 1 (perspective)
    double depth_m = 0;  ///< parallel light: metres that depths from 0 to 1 span
};

/// A light as its samples see it.
struct ExactLight {
    ExactView view[6];
    std::int32_t views = 1;  ///< 1, or 6: the one that cube_face() names for the sample
    bool directional = true;
    float to_light[3] = {0, 1, 0};  ///< directional: unit
    float position[3] = {0, 0, 0};  ///< otherwise; relative to the eye
    double eye[3] = {0, 0, 0};
    /// Where the camera looks from, homogeneous: its eye, or against the way that an orthographic one looks.
    double viewer[4] = {0, 0, 0, 1};
    /// 1/256 pixel at p, relative to the eye, metres: snapping_m + snapping_per_m (|x| + |y| + |z|).
    float snapping_m = 0, snapping_per_m = 0;
    const float* positions = nullptr;        ///< of the mesh, x y z each,
    const std::uint32_t* corners = nullptr;  ///< and three of them per triangle
};

/// Points that a camera sees, all of them with one eye: arrays of `count`, a multiple of sixteen. Bit i of a
/// mask word is point 16 g + i.
struct ExactPoints {
    std::int32_t count = 0;
    const double *px, *py, *pz;     ///< world space, metres, on the plane of their face
    const float *gx, *gy, *gz;      ///< geometric normal, turned to the viewer
    const std::uint32_t* face;      ///< planar face of each (Mesh::face),
    const std::uint32_t* triangle;  ///< and triangle
    const std::uint32_t* covered;   ///< points that there are
    const std::uint32_t* thin;      ///< on surfaces that let light through, which have no dark side
};

/// Points on the grids of a light's views, and those alone that must be looked up: arrays with room for all.
struct ExactSamples {
    std::int32_t count = 0;
    std::int32_t *x, *y;   ///< on the grid of the point's view
    float* z;              ///< depth there
    float* rounding;       ///< metres that are uncertain of its place
    std::uint32_t* point;  ///< which
    std::uint8_t* view;
};

/// Whether p lies on its triangle, of those on its plane: inside of all edges.
[[gnu::always_inline]] inline bool is_on_triangle(const ExactLight& light, std::uint32_t triangle,
                                                  const double (&p)[3]) {
    double c[3][3], e[3][3];
    for (int k = 0; k < 3; ++k) {
        const float* at =
            light.positions +
            3 * static_cast<std::size_t>(
                    light.corners[3 * static_cast<std::size_t>(triangle) + static_cast<std::size_t>(k)]);
        for (int a = 0; a < 3; ++a)
            c[k][a] = static_cast<double>(at[a]);
    }
    for (int k = 0; k < 3; ++k) {
        for (int a = 0; a < 3; ++a)
            e[k][a] = c[k == 2 ? 0 : k + 1][a] - c[k][a];
    }
    const double n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                         e[0][0] * e[1][1] - e[0][1] * e[1][0]};
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
        const double d[3] = {p[0] - c[k][0], p[1] - c[k][1], p[2] - c[k][2]};
        const double side =
            (n[0] * (e[k][1] * d[2] - e[k][2] * d[1]) + n[1] * (e[k][2] * d[0] - e[k][0] * d[2])) +
            n[2] * (e[k][0] * d[1] - e[k][1] * d[0]);
        inside = inside && side >= 0;
    }
    return inside;
}

/// How far behind the plane of a triangle with unit normal n a point may seem to lie that 1/256 pixel beside
/// its place lies before it: p relative to the eye, g the unit normal of its own plane, turned to the viewer.
[[gnu::always_inline]] inline float exact_snap(const ExactLight& light, const float (&p)[3],
                                               const float (&g)[3], const double (&n)[3]) {
    const float reach = (__builtin_fabsf(p[0]) + __builtin_fabsf(p[1])) + __builtin_fabsf(p[2]);
    // Towards the viewer.
    float v[3];
    for (int k = 0; k < 3; ++k)
        v[k] = light.viewer[3] != 0 ? -p[k] : static_cast<float>(light.viewer[k]);
    const float facing = (g[0] * v[0] + g[1] * v[1]) + g[2] * v[2];
    const float cosine = facing / __builtin_sqrtf((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
    const float along = (light.snapping_m + light.snapping_per_m * reach) /
                        (cosine > exact_least_cosine ? cosine : exact_least_cosine);
    // Times the sine between the planes.
    float c[3];
    for (int k = 0; k < 3; ++k) {
        const int i = k == 2 ? 0 : k + 1, j = 3 - k - i;
        c[k] = g[i] * static_cast<float>(n[j]) - g[j] * static_cast<float>(n[i]);
    }
    return along * __builtin_sqrtf((c[0] * c[0] + c[1] * c[1]) + c[2] * c[2]);
}

/// Work done, for tests and charts: nothing of it depends on threads.
struct ExactCounts {
    std::int64_t samples = 0;    ///< looked up
    std::int64_t groups = 0;     ///< of boxes that were looked at, sixteen boxes each
    std::int64_t triangles = 0;  ///< looked at, each for sixteen samples

    ExactCounts& operator+=(const ExactCounts& o) {
        samples += o.samples;
        groups += o.groups;
        triangles += o.triangles;
        return *this;
    }
};

/// exact_locate: of every point that light reaches, the bit in `lit` (as ExactPoints' masks): not of those
/// that are not there, nor of those that face away. Kernels take points in bunches of sixteen, sixteen
/// bunches at a time, as they come; where these stand together on the light's grid, they are done. Others
/// become samples, and so does with `ref` whatever something may darken. exact_darken: takes the bits of
/// darkened samples out of `lit`. order[i]: sample that stands at place i; sixteen neighbours in that order
/// are looked up together, so they should be neighbours on the grid, and views should follow one another. Any
/// order gives the same bits. Adds to `counts`.
#define OBSCURA_EXACT                                                                                  \
    void exact_locate(const ExactPoints& points, const ExactLight& light, ExactSamples& samples,       \
                      std::uint32_t* lit, ExactCounts& counts) noexcept;                               \
    void exact_darken(const ExactPoints& points, const ExactLight& light, const ExactSamples& samples, \
                      const std::uint32_t* order, std::uint32_t* lit, ExactCounts& counts) noexcept;
namespace ref {
OBSCURA_EXACT
}
namespace sse2 {
OBSCURA_EXACT
}
namespace avx2 {
OBSCURA_EXACT
}
namespace avx512bw {
OBSCURA_EXACT
}
#undef OBSCURA_EXACT

}  // namespace obscura
