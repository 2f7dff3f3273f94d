#pragma once
// What patterns and glare hold, known before any of it is made.

#include <cstdint>
#include <optional>

#include "app/scene/scene.h"

namespace obscura {

/// Bytes beside the frame, from the scene's keys: kernels of the open lens, of lamps partly hidden and out of
/// focus (expected_kernels()), and the largest of what making a pattern, making a near field and spreading
/// the light take while the kernels are kept. `margin_px`: of glare_margin().
/// `lamps`: objects that clip by themselves (lamp_count()); 0
/// where they are not known yet, and then their kernels are not counted. `bright_px`: pixels that glare;
/// without a value a sixteenth of them all is expected.
std::int64_t glare_bytes(const OpticsSettings& optics, const RenderSettings& render, int margin_px,
                         std::int64_t lamps, std::optional<std::int64_t> bright_px);

/// Kernels that are kept until the light is spread: of every step of focus, and of a quarter of the lamps
/// (few stand behind something) visibility_samples each.
std::int64_t expected_kernels(const OpticsSettings& optics, std::int64_t lamps);

/// Kernels that a picture may keep: as many more than expected as there is room for in `free_bytes`, what
/// limits leave of memory beside all that is estimated.
std::int64_t kernels_that_fit(const Scene& scene, std::int64_t free_bytes);

}  // namespace obscura
