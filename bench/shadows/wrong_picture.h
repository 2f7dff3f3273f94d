#pragma once
// A picture of where a map's shadows are wrong.

#include "bench/shadows/wrong_pixels.h"
#include "core/image.h"
#include "core/pixel.h"

namespace obscura {

/// The scene in greys, lit and shadowed as it truly is, half the width and height of scene.points' picture;
/// wrong pixels in colour: outlines vermilion, inside purple, open surfaces orange, grazing light blue.
/// `kinds`: of wrong_pixels().
Image<Rgb8> wrong_picture(const TrueShadows& scene, const std::vector<std::uint8_t>& kinds);

}  // namespace obscura
