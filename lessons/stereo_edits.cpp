#include "lessons/stereo_edits.h"

namespace obscura {

std::vector<StereoEdit> lesson_edits(const MiddleView& view, double back_px) {
    const double pixel = view.picture_width / 360.0;
    return {{"rounder ball", 1, RoundnessEdit{{{stereo_object::ball}, {}}, 3, false}},
            {"bust pushed back", 1, AnchorEdit{{{stereo_object::bust}, {}}, -back_px * pixel}}};
}

StereoEdit lesson_match(const MiddleView& view) {
    const double pixel = view.picture_width / 360.0;
    return {"block follows ball", 1,
            MatchEdit{{200 * pixel, 150 * pixel}, {91 * pixel, 150 * pixel}, 0, 0, false}};
}

EditedSystem lesson_system(const StereoScene& scene, const MiddleView& view,
                           const std::vector<StereoEdit>& edits, const EditParams& params, const Exec& exec) {
    return edited_system(view, edits, params, object_names(scene.mesh), exec);
}

DisparityMap minimiser(const DisparitySystem& system, const Exec& exec) {
    SolverParams params;
    params.tolerance_max_px = params.tolerance_rms_px = 1e-5;
    return solve(system, params, exec).disparity;
}

}  // namespace obscura
