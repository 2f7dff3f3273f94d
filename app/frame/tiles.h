#pragma once
// All tiles of a frame.

#include "app/frame/frame.h"
#include "app/frame/tile.h"
#include "core/isa.h"

namespace obscura {

/// Gives the frame the crop's size: radiance and the channels that are wanted.
void size_frame(const Region& crop, const FrameOptions& options, Frame& frame);

/// Renders the tiles that the frame's pixels lie in, or adds a pass to them (scene.pass). Adds to
/// frame.stats, whose lights are those of `scene` with shadows.
void render_tiles(const TileScene& scene, const FrameOptions& options, const Exec& exec, Frame& frame);

}  // namespace obscura
