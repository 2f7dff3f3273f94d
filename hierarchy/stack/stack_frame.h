#pragma once
// Where the maps of a stack look: one plane keeps its texels in all of them. POD: kernels include this.
//
// Let h be a point's height above the plane (towards the light), A and B the texels below it on the plane,
// and g = h / (1 - tau h). The map of sample k shows the point at
//   X = (A + sigma_x h) / (1 - tau h)     Y = (B + sigma_y h) / (1 - tau h)     Z = depth_top - depth_per_m g
// where a light at height H above texel (a, b) of the plane has sigma = -(a, b) / H and tau = 1 / H, and
// light that travels along d, with texels (a, b) a metre and falling by f a metre, has sigma = (a, b) / f and
// tau = 0. On the plane h = 0: X = A, Y = B and Z = depth_top in every map. Where all samples are parallel to
// the plane, tau is the same for all, so are depths, and X, Y are affine in the sample's place.

#include <cstdint>

namespace obscura {

/// What all maps of a stack share, for points relative to some origin.
struct StackFrame {
    double a[4] = {0, 0, 0, 0};  ///< A = a . (x, y, z, 1), texels
    double b[4] = {0, 0, 0, 0};  ///< B
    double h[4] = {0, 0, 0, 0};  ///< metres
    double depth_top = 0, depth_per_m = 0;
    double near_h = 3e38;  ///< what is as high or higher lies before the near plane of every map: it is lit
    friend bool operator==(const StackFrame&, const StackFrame&) = default;
};

/// What makes a map of its own: see above. Floats, so that maps and lookups use the same.
struct SliceView {
    float sigma_x = 0, sigma_y = 0;  ///< texels a metre
    float tau = 0;                   ///< 1 / metre
    friend bool operator==(const SliceView&, const SliceView&) = default;
};

/// Least and greatest of each over a run of maps; low > high where the run has none.
struct SliceRange {
    float sigma_x[2] = {1, -1}, sigma_y[2] = {1, -1}, tau[2] = {1, -1};
};

}  // namespace obscura
