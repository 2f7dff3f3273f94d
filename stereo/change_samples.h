#pragma once
// What upsampling knows of a low-resolution pixel: the change there and a linear model of it around.

#include <cstdint>

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "stereo/middle_view.h"

namespace obscura {

/// The change near a sample: change + per_disparity * (disparity difference) + per_column * (columns to the
/// right) + per_row * (rows down), columns and rows of full resolution.
struct ChangeSample {
    float change = 0, per_disparity = 0, per_column = 0, per_row = 0;
    float disparity = 0;
    std::uint32_t object = nothing_seen;
    Vec3f normal;
};

/// Fits the model to the 3 x 3 samples around each that are of its object: least squares, through the sample
/// itself, drawn a little towards 0 so that what the samples do not tell (a plane's disparity is linear in
/// position) is shared out and stays finite. Where the change hardly varies, there is no model.
Image<ChangeSample> change_samples(const MiddleView& full, const MiddleView& low, const Image<float>& change,
                                   double steepest_change, const Exec& exec);

}  // namespace obscura
