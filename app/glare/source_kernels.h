#pragma once
// Kernels that differ from source to source: by what hides the lens from it, or by how far it is out of
// focus.

#include <cstdint>
#include <vector>

#include "app/glare/lit_picture.h"
#include "app/scene/scene.h"
#include "optics/field/aperture.h"

namespace obscura {

/// kernels[0] is the open lens in focus; choice(x, y) names the kernel of a pixel that clips. Channels sum to
/// 1, or with visibility "exact" to the share of the lens's light that what is not hidden lets through.
struct SourceKernels {
    std::vector<Image<Vec3f>> kernels;
    Image<std::uint16_t> choice;
    std::size_t most = 65536;         ///< kernels, those that memory has room for
    std::int64_t hidden_sources = 0;  ///< pixels that see a lens partly hidden, or are out of focus
};

/// The most kernels that one frame's sources may choose from.
constexpr std::size_t most_kernels = 65536;

/// Its index. Throws LimitError when there are most_kernels, or to.most, already.
std::uint16_t add_kernel(Image<Vec3f> kernel, SourceKernels& to);

/// True when the scene asks for such kernels; they need the frame's depth (and object) channels.
bool wants_source_kernels(const OpticsSettings& optics);

/// Of a picture that knows what its pixels show: adds to `to`, which has the kernel of the open lens in focus
/// (each channel of sum 1), those of other sources, and chooses. `clip`: radiance from which on pixels glare.
void add_source_kernels(const Scene& scene, const LitPicture& picture, double clip, const Aperture& aperture,
                        const Exec& exec, SourceKernels& to);

}  // namespace obscura
