#pragma once

#include <string>

#include "app/scene/scene.h"

namespace obscura {

/// What `obscura check` tells: the lens, the kernel, the cost; lines begin with a word of ten columns.
/// `margin_px`: of glare_margin().
std::string lens_text(const OpticsSettings& optics, const RenderSettings& render, int margin_px);

}  // namespace obscura
