#pragma once
// Hours of direct sun: how long the sun reaches what a pixel shows, over a sun's path.
//
// A path is a row of suns (core/sun_path.h), each for a part of the day. Every sample of the picture asks
// each of them by an exact shadow (raster/exact), and counts the hours of those that reach it: a surface that
// faces away from a sun has none of it. Pass after pass over the tiles adds what some of the suns give, and
// their casters are dropped, so memory is that of a pass. The sun's disc and haze are left out; what a step
// cannot tell is when within it the sun came.

#include <cstdint>

#include "app/frame/frame.h"
#include "app/scene/scene.h"
#include "core/isa.h"
#include "core/mesh_memory.h"

namespace obscura {

struct TileScene;

/// The sun whose path is taken: the scene's first. Null: none is a sun.
const Light* sun_with_path(const Scene& scene);

/// Suns that one pass asks, of `suns` in all, and the bytes of what it then holds.
int suns_together(const MeshSize& mesh, int suns);
std::int64_t sun_pass_bytes(const MeshSize& mesh, int suns);
/// Passes over the tiles, one at least.
int sun_passes(const MeshSize& mesh, int suns);

/// Gives the frame, whose size is set, its sun_hours, and stats.sun_hours. options.progress is told of them
/// as of a whole; when cancelled, the frame is not complete. `sun` has a path.
void add_sun_hours(const TileScene& tiles, const Light& sun, const FrameOptions& options, const Exec& exec,
                   Frame& frame);

}  // namespace obscura
