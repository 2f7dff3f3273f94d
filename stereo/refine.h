#pragma once
// Triangles become finer until the moved surface follows the map, and only where it does not.
//
// Thesis 4.3.4 and figure 4.5 tessellate by screen area, in hardware; here by what the map asks for. Linear
// interpolation over a triangle of size h misses a change c by up to h^2/8 |c''|, so flat and merely shifted
// or tilted changes cost nothing, and halving triangles, which takes two cuts, gains a factor of four.

#include "core/isa.h"
#include "stereo/bisection.h"
#include "stereo/moved_mesh.h"
#include "stereo/vertex_gather.h"

namespace obscura {

/// Cuts triangles of `surface` until each visible pixel is within params.tolerance_px of the map, or its
/// triangle is as small as a pixel, was cut params.max_splits times, or there are params.max_triangles.
/// Fills stats.rounds, within and triangles_out.
void refine(const SeenChange& seen, const ReprojectParams& params, const Exec& exec, Bisection& surface,
            ReprojectStats& stats);

}  // namespace obscura
