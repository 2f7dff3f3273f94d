#pragma once
// Disparity systems of the stereo bench and of the solver's tests: one synthetic picture, edited in ways that
// are easy or hard to solve. Disparities grow with the picture's width; widths of 1920 have the sizes named.

#include <vector>

#include "stereo/disparity_system.h"
#include "stereo/middle_view.h"

namespace obscura {

/// The picture: a wall behind the screen, a floor that comes towards it, five spheres, a slanted box and six
/// thin poles in front. The base edits: roundness of three spheres, one sphere anchored, another following
/// one pixel (a matching set of all its pixels), gradients across outlines as they are, epsilon 1e-4. The
/// rest are the base with one thing changed.
enum class StereoCase {
    base,
    no_matching,      ///< without the matching set
    anchors_100,      ///< the anchor weighs 100
    contradictory,    ///< and so do two more, of a sphere and of the floor it stands on, 40 px apart
    epsilon_1e8,      ///< epsilon 1e-8: hardly anything holds the level of what is not anchored
    offset_60,        ///< the anchor is 60 px off
    many_sets,        ///< 16 matching sets, sources anywhere
    sky,              ///< the wall's upper part is sky, where nothing is valid
    one_pixel_poles,  ///< 60 poles of one pixel at any size, every second one anchored 12 px off
    poles_before_sky  ///< both: the poles stand on the floor, and most of each has no neighbours but its own
};

std::vector<StereoCase> stereo_cases();
const char* stereo_case_name(StereoCase stereo_case);

/// What the middle camera sees, without margins. Depths are all 1: nothing here reads them.
MiddleView stereo_bench_view(StereoCase stereo_case, int width, int height);

/// The edits of that view, which may be reduced: terms of single pixels and sets then count reduction^2.
DisparitySystem stereo_bench_system(StereoCase stereo_case, const MiddleView& view);

/// Both in one, at full resolution.
DisparitySystem stereo_bench_system(StereoCase stereo_case, int width, int height);

}  // namespace obscura
