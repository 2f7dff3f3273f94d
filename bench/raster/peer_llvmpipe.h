#pragma once
// llvmpipe (Mesa's software OpenGL, through OSMesa) as a peer: the rasterizer that CPU-only machines use
// today.

#include "bench/harness/contestant.h"

namespace obscura {

/// Jobs: depth-only light views with and without back-face culling; dual depth by two-pass depth peeling, and
/// by nearest front face plus nearest back face; a Phong frame with a one-tap shadow map, map included or
/// kept. Absent when the build did not find OSMesa's header; opening fails where the library cannot be
/// loaded.
Contestant llvmpipe_contestant();

}  // namespace obscura
