#pragma once
// The keys of [stereo] and the settings that they set.

#include "app/scene/key_row.h"
#include "app/scene/stereo_settings.h"

namespace obscura {

/// Without members: what stereo_settings() turns into pixels of the frame.
const KeyRows<StereoSettings>& stereo_rows();

}  // namespace obscura
