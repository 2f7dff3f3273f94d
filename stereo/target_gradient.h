#pragma once
// The gradient that the optimised map should have (thesis 4.2 and 4.3.3): roundness inside objects, the
// original's or D~'s between them, interface edits and masks, inversions reset, folds limited.

#include "stereo/edit.h"
#include "stereo/edit_classes.h"
#include "stereo/edit_shape.h"

namespace obscura {

/// Writes system.gradient_x and gradient_y from system.original and system.start (D~).
void write_target_gradients(const MiddleView& view, const ClassMap& map,
                            const std::vector<ClassShape>& shapes,
                            const std::vector<const StereoEdit*>& edits, const EditParams& params,
                            const Exec& exec, DisparitySystem& system);

}  // namespace obscura
