#pragma once

#include <vector>

#include "app/scene/shapes.h"

namespace obscura {

/// The generators of room scenes (scenes/generators.h, scenes/city.h) as shapes of a [[mesh]].
std::vector<ShapeSpec> generator_shapes();

}  // namespace obscura
