#pragma once
// Hours of sun as a picture that a planner can read: colours, and below them what they mean.

#include "app/frame/frame.h"
#include "core/image.h"
#include "core/pixel.h"

namespace obscura {

/// Rows that the scale takes below the picture: none where the picture is too narrow for its numbers.
int sun_hours_scale_rows(int width);

/// `hours` in colours from dark blue (none) over green to yellow (`stats.sunlit_h()`, what open level ground
/// has), lightness rising evenly (`heat`, lessons/drawing); grey where nothing is (NaN). Below them a bar of
/// these colours with ticks at whole hours, and the date. The same scale for every crop and frame of a day.
Image<Rgb8> sun_hours_picture(ImageView<const float> hours, const SunHoursStats& stats);

}  // namespace obscura
