#pragma once
// resolution = "auto": how fine a light's map must be for the picture at hand.
//
// A. Lefohn, S. Sengupta, J. Owens, "Resolution-Matched Shadow Maps", ACM TOG 26(4), 2007, section 3, ask for
// a texel per pixel everywhere and build only what is seen; so do we, with one resolution per map, which a
// compressed map can afford.
//
// The rule. Every pixel counts by its first sample, if that asks the map: it sees a surface that is turned to
// the light (or thin), within the light's range and cone, inside the map. To first order, the pixel covers a
// parallelogram of the surface's plane, and that another one of the map, whose shorter axis (the least
// singular value) is s texels. A texel is magnified 1/s times there. The resolution is the smallest power of
// two at which no pixel's magnification is above ShadowSettings::max_magnification; no outliers are left
// out. Two bounds: surfaces that the light grazes at less than 7.2 degrees (cosine 1/8) count as if it were
// that, since s shrinks with the cosine to nothing, but the light that a shadow could take away does so too;
// and the result is at most most_map_resolution.

#include <functional>
#include <span>
#include <vector>

#include "app/frame/light_shadow_stats.h"
#include "app/frame/tile.h"
#include "app/scene/scene.h"
#include "core/isa.h"
#include "raster/view.h"

namespace obscura {

/// A light that asks: its views at a resolution, of which the finest is the most that is found.
struct ResolutionQuery {
    const SceneLight* light = nullptr;
    int most = most_map_resolution;
    std::function<std::vector<LightView>(int)> views;
};

/// Of trees; `casters`: their box along the light's axes (parallel light only).
ResolutionQuery tree_query(const SceneLight& light, const Bounds& casters);
/// Of a stack: the map of the point nearest to the light's middle stands for all. `light` and `mesh` must
/// outlive it.
ResolutionQuery stack_query(const Mesh& mesh, const SceneLight& light);

/// One answer per query, the same for any exec. `pictures`: whole ones, of which every pixel counts; their
/// lights are not read.
std::vector<FoundResolution> find_resolutions(std::span<const TileScene> pictures, Vec3d eye,
                                              std::span<const ResolutionQuery> queries, const Exec& exec);

/// Shorter axis, in texels of the map, of what a pixel covers there; 0 when it sees the surface edge on, or
/// light does. x, y: the sample's place in the picture, pixels.
double footprint_texels(const CameraRays& rays, const PcfView& view, const SurfaceBlock& surface, int at,
                        double x, double y);

}  // namespace obscura
