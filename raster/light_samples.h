#pragma once
// A light with a size as many without: points of its surface, or directions of its disc, whose shadows are
// hard and whose sum has penumbrae.

#include <vector>

#include "core/scene.h"

namespace obscura {

/// Whether the light has a size, and so penumbrae.
bool has_size(const Light& light);

/// `count` lights without size that shine together as `light` does; {light} itself, seen from its middle,
/// when it has no size or count is 1. Evenly spread, and so is every m-th of them from any on, for the m = 2,
/// 4, 16 that share them out among the samples of a pixel.
///
/// A rectangle's points are a Kronecker lattice, (k + 1/2) / count by the golden ratio's multiples; a disc's,
/// in space or in the sky, a sunflower (H. Vogel, "A better way to construct the sunflower head",
/// Mathematical Biosciences 44, 1979), each of as much of it. A ball's lie as densely as 1 / sqrt(R^2 - r^2),
/// which from any side looks like a disc equally bright everywhere (the Abel transform's inverse of a
/// constant). A surface's are small area lights on it (core/emitter_surface.h).
std::vector<Light> light_samples(const Light& light, int count);

}  // namespace obscura
