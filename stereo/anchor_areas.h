#pragma once
// Who asked for which disparity where: what reports name when edits contradict each other.

#include "stereo/edit_classes.h"
#include "stereo/edit_shape.h"

namespace obscura {

/// One area per anchor edit that is seen, with what it alone asks for, and one for the comfort zone and the
/// sides of the picture together, where they hold back what edits ask for: wherever `system` has an anchor of
/// more than the edits' weight. Call it when the system's anchors are written.
std::vector<AnchorArea> anchor_areas(const ClassMap& map, const std::vector<ClassShape>& shapes,
                                     const std::vector<const StereoEdit*>& order, const EditParams& params,
                                     const DisparitySystem& system);

}  // namespace obscura
