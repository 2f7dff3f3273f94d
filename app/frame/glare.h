#pragma once
// Glare of a frame: after its tiles, before its tone curve.

#include <optional>

#include "app/frame/frame.h"
#include "app/scene/scene.h"
#include "core/isa.h"

namespace obscura {

/// The kernel of one lens, kept while the lens and the size of its pixels stay.
struct KeptPsf {
    OpticsSettings lens;
    double pixel_m = 0;
    Image<Vec3f> kernel;  ///< every channel sums to 1
    double cycles_per_px = 0, captured = 0;
    int wavelengths = 0;
};

/// Spreads the light of the frame's bright pixels, when the scene has a lens; the frame is the whole picture
/// with its margin.
/// Nothing is computed when nothing clips. Fills stats.glare. Options: `progress` hears which share of the
/// pattern is done; `cancel` ends it and leaves the frame incomplete.
void add_frame_glare(const Scene& scene, const FrameOptions& options, const Exec& exec,
                     std::optional<KeptPsf>& kept, Frame& frame);

/// Leaves of a frame's channels those pixels that lie in the crop (of the whole picture, as the frame's x0
/// and y0 are).
void crop_frame(const Region& crop, Frame& frame);

}  // namespace obscura
