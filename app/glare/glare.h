#pragma once
// Glare of a picture: after it is rendered, before its tone curve.

#include <atomic>
#include <functional>
#include <optional>

#include "app/glare/lit_picture.h"
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

/// What whoever renders the picture hears and says meanwhile; all may be empty.
struct GlareCall {
    std::function<void(double)> progress;       ///< which share of the lens's pattern is done
    const std::atomic<bool>* cancel = nullptr;  ///< set it, and the pattern is left
    /// Throws LimitError when so many pixels glare that memory has no room for what they take.
    std::function<void(std::int64_t bright_px)> check_bright;
    std::function<std::int64_t()> free_bytes;  ///< what limits leave for kernels beside those expected
};

/// Spreads the light of the bright pixels of a picture whose scene has a lens. Nothing is computed when
/// nothing clips. None: cancelled, and only the margin is dimmed.
std::optional<GlareStats> add_glare(const Scene& scene, const GlareCall& call, const Exec& exec,
                                    std::optional<KeptPsf>& kept, const LitPicture& picture);

}  // namespace obscura
