#pragma once
// Shadow lookups with percentage-closer filtering. POD: kernels include this.
//
// W. Reeves, D. Salesin, R. Cook, "Rendering Antialiased Shadows with Depth Maps", SIGGRAPH 1987: compare
// first, then filter. A kernel of side K takes the K x K texels around the texel that holds the receiver, no
// others. Along each axis, with f in [0, 1) the receiver's place in its own texel, to 1/256, they weigh
//   K = 1:  1        K = 3:  (1 - f, 1, f) / 2        K = 5:  (1 - f, 1, 1, 1, f) / 4,
// which is the box of K - 1 texels that is centred on the receiver itself: visibility changes continuously as
// the receiver moves, and shadow edges are ramps, not stairs.
//
// A receiver is lit by a texel when its depth <= the stored depth, and wherever the map of a parallel light
// does not reach. Taps of points and spots are clamped into their map: a point's six reach everywhere, and
// beyond a spot's there is no light but for receivers that their offset moved there.
//
// "Its depth" at a texel is that of the receiver's own plane at the texel's centre, where the map sampled it,
// but not more than the receiver's own (J. Isidoro, "Shadow Mapping: GPU-based Tips and Techniques", GDC
// 2006, receiver plane depth). A planar face thus meets its own stored plane, which lies before the middle of
// the solid however thin that is; with one depth for all texels, a slab thinner than texel x slope shades
// itself. What stands before the plane still shades it. Never deeper than the receiver: behind a thin wall
// that stands on lit ground the ground's plane goes on, and would find itself in the wall's shadow.
//
// The stored depths come from a dense map or from a serialised tree (filters/tree_pcf.h). Trees can also be
// filtered hierarchically: see PcfFilter.

#include <cstdint>

#include "hierarchy/tree_code.h"
#include "raster/camera_rays.h"
#include "raster/gbuffer.h"

namespace obscura {

/// One view of a shadow map, for receivers relative to the eye.
struct PcfView {
    double to_map[4][4];             ///< LightView::to_map after the shift by the eye
    const float* stored = nullptr;   ///< size x size depths, in blocks as StoredDepths has them; or null and
    const TreeCode* tree = nullptr;  ///< a tree of 2^levels = size texels a side
    std::int32_t size = 0;
    bool perspective = false;
    double near_w = 0;    ///< perspective: receivers nearer than this are lit
    double offset_m = 0;  ///< normal offset of receivers on open or inside-out components, at distance 1 if
                          ///< perspective; 0: none
    /// On a plane with normal n, with l to the light (unit, or from the receiver to its position):
    /// dZ/dX = n . slope_x / n . l, and the same for Y.
    float slope_x[3] = {0, 0, 0}, slope_y[3] = {0, 0, 0};
    /// The plane moved by d metres along n: dZ = d step / n . l, by w if perspective.
    float step = 0;
};

/// What is certain of a receiver's depth. A map may store the very depth of the receiver's own plane (where
/// two solids touch, one interval ends where the other begins), so that depth is taken nearer to the light by
/// all that rounding may have moved it, and no more:
///  - the receiver's position is a float, relative to the eye: at most pcf_position_error (8 half units
///    in the last place) times |x| + |y| + |z| off its plane, which the angle to the light stretches by
///    1 / (n . l);
///  - vertices snap to 1/256 texel, so a texel's centre may see a facet that ends so far from it:
///    pcf_snap times |dZ/dX| + |dZ/dY|; that also covers the rounding of the plane's rise over a kernel;
///  - depths are floats in [0, 1], stored and computed: pcf_depth_error (four units in the last place).
constexpr float pcf_position_error = 0x1p-21f, pcf_snap = 1.0f / 256.0f, pcf_depth_error = 0x1p-22f;

/// Planes that light grazes, at less than 50 seconds of arc, are taken as if it were that: n . l / |l| is no
/// less.
constexpr float pcf_least_cosine = 1.0f / 4096.0f;

/// Of the way from a surface's plane to a point light or spot, the normal offset goes no further than this
/// share: in coarse maps far receivers would else be moved past the light.
constexpr float pcf_nearest_offset = 0.25f;

/// pcf: kernels of texels, whatever a pixel spans on the map. hierarchical (trees only): kernels of squares
/// of 2^l texels that together are as large as the pixel's footprint there, blended between two levels.
///
/// The footprint is the longer of the two vectors by which the pixel's neighbours to the right and below are
/// apart on the map, on the plane of the receiver. The box of K - 1 squares is to span it (K = 1: the
/// square), so squares want f texels a side, f = footprint / (K - 1), at least 1. With l = floor(log2 f),
/// visibility is (1 - t) V(l) + t V(l + 1), t = f / 2^l - 1. V(l) is the kernel above on the map of squares,
/// whose stored depths are those of a descent that stops at level l: depths that suit some texel of the
/// square, not all. So the receiver's plane is taken where it is nearest to the light among the texel centres
/// of a tap's square: at its middle, less (|dZ/dX| + |dZ/dY|) (2^l - 1) / 2. A lit plane whose square stores
/// the depth of any one of its texels then finds itself lit, and at level 0 there is no bias. (The authors'
/// demo subtracts 5e-5 (l^2 + 1) of the depth range instead.)
enum class PcfFilter : std::int32_t { pcf, hierarchical };

/// Largest kernel side on trees; dense maps have 1, 3 and 5.
constexpr std::int32_t max_tree_pcf_side = 15;

/// A light as its shadow lookups see it.
struct PcfLight {
    PcfView view[6];
    std::int32_t views = 1;  ///< 1, or 6: the one that cube_face() names for the receiver
    std::int32_t side = 3;   ///< kernel side: 1, 3 or 5 texels; on trees any odd number to 15
    bool directional = true;
    float to_light[3] = {0, 1, 0};  ///< directional: unit
    float position[3] = {0, 0, 0};  ///< otherwise; relative to the eye
    PcfFilter filter = PcfFilter::pcf;
    CameraRays camera = {};  ///< hierarchical: what gives pixels their footprint
};

/// visibility[i] in [0, 1] of every sample of the block: 0 where nothing is covered, and without a lookup
/// where the face looks away from the light (thin surfaces are looked up on both sides). Receivers on
/// components that are open or inside out are moved along their normal, to the light's side, by offset_m:
/// maps hold no solid behind those. (The wall of a cavity is inside out too; there it does no harm.)
#define OBSCURA_PCF_BLOCK \
    void pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept;
namespace ref {
OBSCURA_PCF_BLOCK
}
namespace sse2 {
OBSCURA_PCF_BLOCK
}
namespace avx2 {
OBSCURA_PCF_BLOCK
}
namespace avx512bw {
OBSCURA_PCF_BLOCK
}
#undef OBSCURA_PCF_BLOCK

}  // namespace obscura
