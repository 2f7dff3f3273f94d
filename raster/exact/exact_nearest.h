#pragma once
// What stands before points that a light does not reach: of all triangles that darken a point (exact.h) the
// one nearest to it, towards the light. POD: kernels include this.
//
// The final gather of light that surfaces send on, direction by direction for all points of a picture at
// once, as T. Hachisuka, "High-Quality Global Illumination Rendering Using Rasterization", GPU Gems 2,
// chapter 38, 2005, peels depths for; here without peeling and without a map: the answer is exact.

#include "raster/exact/exact.h"

namespace obscura {

/// Arrays as long as ExactPoints. Only places of points that something darkens are written.
struct ExactHits {
    std::uint32_t* triangle;  ///< index into the mesh
    float* distance_m;        ///< to it, from the point towards the light
};

/// Cosine between a triangle's normal and the way to parallel light. A point that lies `behind` its plane has
/// it that far before itself over this. Planes that the light sees along themselves are far.
[[gnu::always_inline]] inline double exact_cosine(const CasterTriangle& t, const ExactLight& light) {
    constexpr double least = 0x1p-30;
    const double cosine =
        (t.n[0] * static_cast<double>(light.to_light[0]) + t.n[1] * static_cast<double>(light.to_light[1])) +
        t.n[2] * static_cast<double>(light.to_light[2]);
    return cosine > least ? cosine : least;
}

/// No point has a triangle nearer before itself than the triangle's farthest corner from the light is,
/// however its plane runs on: metres between depth z of the point and z_high of the triangle, or of what
/// bounds it.
[[gnu::always_inline]] inline double exact_least_distance(const ExactView& view, float z, float z_high) {
    return (static_cast<double>(z) - static_cast<double>(z_high)) * view.depth_m;
}

/// Whether (distance, triangle) is nearer; of triangles as near as each other, the first in the mesh.
[[gnu::always_inline]] inline bool exact_is_nearer(double distance, std::uint32_t triangle,
                                                   double than_distance, std::uint32_t than_triangle) {
    return distance < than_distance || (distance == than_distance && triangle < than_triangle);
}

/// Shadows and what casts them, of parallel light, as exact_locate and exact_darken find shadows alone: the
/// same bits of `lit`, and for each point that casters keep the light from, the nearest triangle before it.
/// exact_locate_nearest: what stands together is done as it comes, the rest becomes samples; exact_nearest:
/// those, in whatever order. Adds to `counts`.
#define OBSCURA_EXACT_NEAREST                                                                            \
    void exact_locate_nearest(const ExactPoints& points, const ExactLight& light, ExactSamples& samples, \
                              std::uint32_t* lit, const ExactHits& hits, ExactCounts& counts) noexcept;  \
    void exact_nearest(const ExactPoints& points, const ExactLight& light, const ExactSamples& samples,  \
                       const std::uint32_t* order, std::uint32_t* lit, const ExactHits& hits,            \
                       ExactCounts& counts) noexcept;
namespace ref {
OBSCURA_EXACT_NEAREST
}
namespace sse2 {
OBSCURA_EXACT_NEAREST
}
namespace avx2 {
OBSCURA_EXACT_NEAREST
}
namespace avx512bw {
OBSCURA_EXACT_NEAREST
}
#undef OBSCURA_EXACT_NEAREST

}  // namespace obscura
