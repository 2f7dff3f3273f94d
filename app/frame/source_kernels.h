#pragma once
// Kernels that differ from source to source: by what hides the lens from it, or by how far it is out of
// focus.

#include <cstdint>
#include <vector>

#include "app/frame/frame.h"
#include "app/scene/scene.h"
#include "optics/field/aperture.h"

namespace obscura {

/// kernels[0] is the open lens in focus; choice(x, y) names the kernel of a pixel that clips. Channels sum to
/// 1, or with visibility "exact" to the share of the lens's light that what is not hidden lets through.
struct SourceKernels {
    std::vector<Image<Vec3f>> kernels;
    Image<std::uint16_t> choice;
    std::int64_t hidden_sources = 0;  ///< pixels that see a lens partly hidden, or are out of focus
};

/// The most kernels that one frame's sources may choose from.
constexpr std::size_t most_kernels = 65536;

/// Its index. Throws LimitError when there are most_kernels already.
std::uint16_t add_kernel(Image<Vec3f> kernel, SourceKernels& to);

/// Objects of the scene whose own light clips: only they have patterns of their own when partly hidden.
std::int64_t lamp_count(const Scene& scene);

/// Held of each bright pixel of a lamp while kernels are chosen, lists growing included.
constexpr std::int64_t bytes_per_lamp_pixel = 160;

/// True when the scene asks for such kernels; they need the frame's depth (and object) channels.
bool wants_source_kernels(const OpticsSettings& optics);

/// The frame: radiance, depth_m and object of the whole picture. `clip`: radiance from which on pixels glare.
/// `open`: the kernel of the lens in focus, each channel of sum 1.
SourceKernels source_kernels(const Scene& scene, const Frame& frame, double clip, const Aperture& aperture,
                             const Image<Vec3f>& open, const Exec& exec);

/// The near field of the aperture for a point of light out of focus: a kernel of side 2 radius + 1, channels
/// of sum 1. `vergence_per_m`: 1 / distance - 1 / focus distance; positive for points nearer than the focus,
/// which show the aperture upside down.
Image<Vec3f> defocus_kernel(const Aperture& aperture, const OpticsSettings& optics,
                            const RenderSettings& render, double vergence_per_m, const Exec& exec);

}  // namespace obscura
