#pragma once
// The change of disparity at a point of the surface, gathered from the map around it.
//
// Scandolo, Bauszat, Eisemann, "Gradient-Guided Local Disparity Editing", CGF 2018 (thesis, section 4.3.4,
// "Disparity reprojection"): a cross-bilateral filter (Eisemann and Durand, "Flash photography enhancement
// via intrinsic relighting", SIGGRAPH 2004; Petschnigg et al., ibid.) by position, depth, normal, object.
// Instead:
//  - the change is gathered, not the disparity. Original disparity is scale / z - offset, which is linear on
//    the screen over a flat triangle and known exactly at every vertex; only what edits added has to be
//    looked up, interpolated and refined. Nothing edited, nothing refined, and no filter blurs the original.
//  - samples are fitted by a plane instead of averaged: an average is off by the slope wherever samples lie
//    to one side only, which is at every silhouette and border of the map. The plane may lean along original
//    disparity, too: that is what roundness does, and towards a ball's outline, where it falls ever faster,
//    no plane over the screen alone could follow.
//  - depth and normal act as one: how far the point lies from the sample's tangent plane.

#include <optional>

#include "core/image.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "stereo/map_projection.h"
#include "stereo/middle_view.h"
#include "stereo/surface_points.h"

namespace obscura {

/// What is gathered from. `view` must outlive it.
struct SeenChange {
    const MiddleView& view;
    MapProjection projection;
    Image<float> change_px;          ///< optimised minus original disparity
    Image<std::uint32_t> component;  ///< per pixel; nothing_seen where nothing is
    int radius_px = 2;
    double scale = 0;  ///< original disparity is scale / z and a constant
    float at(std::uint32_t pixel) const { return change_px.pixels[pixel]; }
    /// How far beyond the range of what a triangle shows its hidden corners may go, times that range. Only
    /// where the map might show them: a triangle that comes from far outside must be free to lean, and there
    /// nobody sees how far.
    double slack(const MapPoint& p) const { return projection.on_map(p) ? 1.0 : 1e6; }
};

/// CHECKs that the view has triangles, that sizes agree, and that the map is finite where something is seen.
SeenChange seen_change(const Mesh& mesh, const Camera& camera, const MiddleView& view,
                       const DisparityMap& optimised, int radius_px, const Exec& exec);

/// The change at `point`, or nothing where the map does not show its surface within radius_px.
std::optional<float> gather_change(const SeenChange& seen, const SurfacePoint& point);

/// The change of whatever the map shows at a point's place, or nearest to it on the border.
float change_at_place(const SeenChange& seen, const MapPoint& place);

}  // namespace obscura
