#pragma once
// Embree 3 as a peer: the ray tracer that CPU renderers use today.

#include "bench/harness/contestant.h"

namespace obscura {

/// Jobs: depth by packets of 16 coherent rays; dual depth by a second ray behind the first hit, and by one
/// ray whose filter keeps the nearest two; a Phong frame with one shadow ray per visible point that faces the
/// light. Absent when the build did not find Embree.
Contestant embree_contestant();

}  // namespace obscura
