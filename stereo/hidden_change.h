#pragma once
// The change of disparity of what the middle view does not show: backs, parts behind others, off-screen
// parts.
//
// Scandolo, Bauszat, Eisemann 2018 (thesis, section 4.3.4): a vertex without samples takes the difference of
// the two maps at its place, which is that of whatever hides it; a wall bulges behind every ball that was
// made rounder, and each eye sees some of that beside the ball. Here a hidden vertex asks its own surface
// first:
//   1. triangles that reach into view go on as they were seen;
//   2. what hangs together with seen surface takes the mean of what it hangs on, ring by ring, smoothed: a
//      membrane, never beyond the values around it;
//   3. unconnected parts of a seen object move whole, as the object does at their place;
//   4. objects that are nowhere seen move whole, by the change of what is seen at their place (the paper's).

#include <span>
#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "stereo/surface_points.h"
#include "stereo/triangle_pixels.h"
#include "stereo/vertex_gather.h"

namespace obscura {

/// Gathers every point's change from the map: sets change_px and `seen`; points not seen keep theirs.
void gather_seen(const SeenChange& seen, const Exec& exec, std::span<SurfacePoint> points);

/// Fills the points that are not `seen`. `triangles` hold indices of points.
void fill_hidden(const SeenChange& seen, std::span<const Triangle> triangles, const TrianglePixels& pixels,
                 const Exec& exec, std::vector<SurfacePoint>& points);

}  // namespace obscura
