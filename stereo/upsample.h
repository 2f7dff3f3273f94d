#pragma once
// A solution of lower resolution at full resolution.
//
// Kopf, Cohen, Lischinski, Uyttendaele, "Joint Bilateral Upsampling", SIGGRAPH 2007, section 3:
// low-resolution samples are weighed by their distance and by how like the full-resolution pixel they are in
// a guide. The guide is the object, original disparity and normal (thesis 4.3.5 solves at 1:8 and leaves the
// rest to the gather at vertices). Different here: what is upsampled is the change, not the map, so that
// slopes and steps of the original survive; objects are not weighed but told apart; and samples carry,
// besides their value, how the change around them follows disparity and position (the local linear model of
// He, Sun, Tang, "Guided Image Filtering", ECCV 2010, section 3.1). A sphere's roundness changes fastest
// beside its outline, where all samples lie to one side: weighing alone is pixels off there, the model is
// exact.

#include <optional>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "stereo/middle_view.h"

namespace obscura {

struct UpsampleParams {
    double disparity_px = 1;     ///< a sample this much nearer or farther weighs half
    double steepest_change = 8;  ///< of change per disparity, either way; more is taken for noise
};

/// `change`, of the size of `low`, at the pixels of `full`. low = reduced(full, n). Pixels that were sampled
/// have their sample's value, a constant change of an object is that constant, no change is 0: exactly. Where
/// no sample of the object is near, its mean change over the view; where it was never sampled, that of its
/// neighbours. 0 where nothing is seen.
Image<float> upsampled_change(const MiddleView& full, const MiddleView& low, const Image<float>& change,
                              const UpsampleParams& params, const Exec& exec);

/// full.disparity plus the upsampled change of `solution` against low.disparity.
DisparityMap upsampled_solution(const MiddleView& full, const MiddleView& low, const DisparityMap& solution,
                                const UpsampleParams& params, const Exec& exec);

/// Mean change per object index, nothing for objects that are not seen; the sum runs in pixel order.
std::vector<std::optional<float>> mean_change_per_object(const MiddleView& view, const Image<float>& change);

}  // namespace obscura
