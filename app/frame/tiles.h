#pragma once
// All tiles of a frame.

#include <functional>

#include "app/frame/frame.h"
#include "app/frame/tile.h"
#include "core/isa.h"

namespace obscura {

/// Gives the frame the crop's size: radiance and the channels that are wanted.
void size_frame(const Region& crop, const FrameOptions& options, Frame& frame);

/// A tile, and which of its pixels are the frame's.
struct TilePlace {
    int column = 0, row = 0;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels of the tile
    int frame_x = 0, frame_y = 0;        ///< where its corner is among the frame's pixels
};

/// How many tiles the frame's pixels lie in.
std::size_t tile_count(const TileScene& scene, const Frame& frame);

/// Calls visit() with each of them, and its number, in parallel. Tells options.progress; false when
/// cancelled.
bool walk_tiles(const TileScene& scene, const FrameOptions& options, const Exec& exec, const Frame& frame,
                const std::function<void(std::size_t, const TilePlace&)>& visit);

/// Renders the tiles that the frame's pixels lie in, or adds a pass to them (scene.pass). Adds to
/// frame.stats, whose lights are those of `scene` with shadows.
void render_tiles(const TileScene& scene, const FrameOptions& options, const Exec& exec, Frame& frame);

}  // namespace obscura
