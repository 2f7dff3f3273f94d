#pragma once
// What the middle camera of a stereo rig sees of a scene: one sample per pixel, nothing shaded.

#include <vector>

#include "app/frame/render_frame.h"
#include "app/scene/scene.h"
#include "core/isa.h"
#include "stereo/edit.h"
#include "stereo/middle_view.h"
#include "stereo/stereo_rig.h"

namespace obscura {

/// Renders the middle view of scene.camera with `margin_px` >= 0 columns more on either side, through the
/// centres of pixels. Normals are those that shading uses. Keeps the tables of the scene's surfaces in
/// `cache`. Throws UsageError for a camera without perspective: its rays are parallel, both eyes would see
/// the same. The same bits for any exec.
MiddleView middle_view(const Scene& scene, const StereoRig& rig, int margin_px, const Exec& exec,
                       FrameCache& cache);

/// Columns that a view needs on either side for both eyes' borders to be in it: half of the widest disparity
/// of `view` (itself without margin, say), edits' own included as far as they tell beforehand, and a few
/// for filters; no more than a quarter of the picture.
int automatic_margin(const MiddleView& view, const std::vector<StereoEdit>& edits);

}  // namespace obscura
