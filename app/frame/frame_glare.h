#pragma once
// Glare of a frame: after its tiles, before it is cropped.

#include <optional>

#include "app/frame/frame.h"
#include "app/glare/glare.h"
#include "app/scene/scene.h"
#include "core/isa.h"

namespace obscura {

/// Spreads the light of the frame's bright pixels, when the scene has a lens; the frame is the whole picture
/// with its margin. Fills stats.glare. Options: `progress` hears which share of the pattern is done; `cancel`
/// ends it and leaves the frame incomplete. Throws LimitError where limits.memory_mib has no room.
void add_frame_glare(const Scene& scene, const FrameOptions& options, const Exec& exec,
                     std::optional<KeptPsf>& kept, Frame& frame);

/// Leaves of a frame's channels those pixels that lie in the crop (of the whole picture, as the frame's x0
/// and y0 are).
void crop_frame(const Region& crop, Frame& frame);

/// Throws LimitError when a frame with so many bright pixels does not fit the scene's limits.
void check_bright_pixels(const Scene& scene, std::int64_t bright_px, const FrameOptions& channels = {});

}  // namespace obscura
