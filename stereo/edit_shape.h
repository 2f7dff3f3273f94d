#pragma once
// What roundness and anchors make of each class of pixels, and D~ (thesis 4.2, 4.3).

#include <vector>

#include "stereo/edit.h"
#include "stereo/edit_classes.h"

namespace obscura {

struct ClassShape {
    double factor = 1;         ///< product of the roundness edits, each blended by its weight
    double centre_px = 0;      ///< D_m
    double lift_px = 0;        ///< what D~ is moved by: the offset, faded in by the anchors' weight up to 1
    double anchor_weight = 0;  ///< sum of the anchors' weights, without c2
    double anchor_offset_px = 0;  ///< their weighted mean offset
};

/// In the canonical order of edits_in_order.
std::vector<ClassShape> shape_classes(const ClassMap& map, const DisparityMap& disparity,
                                      const std::vector<const StereoEdit*>& edits);

/// Edits with a weight, by name and content: an order that does not depend on the one they come in.
std::vector<const StereoEdit*> edits_in_order(const std::vector<StereoEdit>& edits);

/// D with roundness: exactly D where there is none.
inline double rounded(const ClassShape& shape, double d) {
    return d + (shape.factor - 1) * (d - shape.centre_px);
}

/// D~. Pixels without a class keep their disparity.
DisparityMap edited_disparity(const ClassMap& map, const DisparityMap& disparity,
                              const std::vector<ClassShape>& shapes, const Exec& exec);

/// Share of an edit of gradients: its weight, at most 1.
double share_of(const StereoEdit& edit);

}  // namespace obscura
