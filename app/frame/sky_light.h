#pragma once
// The sky's part of a frame's light: what is seen of it, the lights that stand for it, and what surfaces send
// on.

#include <atomic>
#include <span>

#include "app/frame/render_frame.h"
#include "app/frame/tile.h"
#include "app/scene/scene.h"
#include "core/isa.h"

namespace obscura {

/// Makes or keeps the frame's sky and the light that surfaces send on, and gives them to all pictures. False
/// when `cancel` was set meanwhile.
bool give_sky(const Scene& scene, const Exec& exec, FrameCache& cache, std::span<TileScene> pictures,
              const std::atomic<bool>* cancel);

}  // namespace obscura
