#pragma once
// What patterns and glare hold at most, known before any of it is made.

#include <cstdint>

#include "app/scene/scene.h"

namespace obscura {

/// Bytes beside the frame, from the scene's keys alone: kernels of the open lens, of lamps partly hidden
/// (visibility_samples each) and out of focus (focus_steps), and the largest of what making a pattern, making
/// a near field and spreading the light take while the kernels are kept. `lamps`: objects that clip by
/// themselves (lamp_count()); 0 where they are not known yet, and then their kernels are not counted.
std::int64_t glare_bytes(const OpticsSettings& optics, const RenderSettings& render, std::int64_t lamps);

/// Side of the mask that a pattern is made of: outlines are drawn up to 4096 texels wide where the kernel's
/// edge asks for it.
std::int64_t finest_mask_side(const OpticsSettings& optics, const RenderSettings& render);

}  // namespace obscura
