#pragma once
// Last frame's change in this frame's map: where the next solve starts from.
//
// Thesis 4.3.5, "Optimizing Convergence": reprojects the previous disparity map. We carry the change, so that
// what moved keeps its own disparity; and look it up backwards, from this frame's surfaces to last frame's
// pixels (as Nehab et al., "Accelerating Real-Time Shading with Reverse Reprojection Caching", Graphics
// Hardware 2007, do for shading), so that nothing tears.

#include "core/image.h"
#include "core/isa.h"
#include "stereo/middle_view.h"

namespace obscura {

struct Camera;

struct WarmStartParams {
    double depth_tolerance = 0.02;  ///< of the distance: last frame's surface there is the same one
};

/// A frame: its map and the camera that saw it. Both views may be reduced, each by its own number.
struct SeenFrame {
    const MiddleView& view;
    const Camera& camera;
};

/// `change` has the size of previous.view. Each pixel of `current` takes the change at the place where last
/// frame's camera saw its point: bilinear over samples of the same object at the same distance; else the
/// object's mean change; else 0. CHECKs that both cameras are perspective.
Image<float> carried_change(const SeenFrame& previous, const Image<float>& change, const SeenFrame& current,
                            const WarmStartParams& params, const Exec& exec);

/// current.view.disparity plus the carried change: `initial` of solve().
DisparityMap carried_map(const SeenFrame& previous, const DisparityMap& solution, const SeenFrame& current,
                         const WarmStartParams& params, const Exec& exec);

}  // namespace obscura
