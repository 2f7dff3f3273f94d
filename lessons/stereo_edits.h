#pragma once
// The edits that lessons 14 to 17 make to their scene, and what the solver makes of them.

#include <vector>

#include "lessons/stereo_scene.h"
#include "stereo/edit.h"
#include "stereo/solver/solver.h"

namespace obscura {

/// The ball three times as round; the bust pushed back by `back_px` of a picture 360 pixels wide.
std::vector<StereoEdit> lesson_edits(const MiddleView& view, double back_px);
/// The block follows the ball as well: a matching set.
StereoEdit lesson_match(const MiddleView& view);

EditedSystem lesson_system(const StereoScene& scene, const MiddleView& view,
                           const std::vector<StereoEdit>& edits, const EditParams& params, const Exec& exec);
/// As near to the minimiser as floats get.
DisparityMap minimiser(const DisparitySystem& system, const Exec& exec);

}  // namespace obscura
