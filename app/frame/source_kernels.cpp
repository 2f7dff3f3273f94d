// Sources are put into few classes whose patterns are computed: by what they see of the lens, or by how far
// they are out of focus.

#include "app/frame/source_kernels.h"

#include <fmt/format.h>

#include <utility>

#include "app/frame/defocus.h"
#include "app/frame/glare_memory.h"
#include "app/frame/hidden_lamps.h"
#include "core/error.h"

namespace obscura {

std::uint16_t add_kernel(Image<Vec3f> kernel, SourceKernels& to) {
    if (to.kernels.size() >= most_kernels)
        throw LimitError(
            fmt::format("lamps that are partly hidden need more than {} patterns; fewer "
                        "optics.visibility_samples need less",
                        most_kernels));
    if (to.kernels.size() >= to.most)
        throw LimitError(
            fmt::format("sources need more than the {} patterns that fit into what limits.memory_mib leaves; "
                        "fewer optics.visibility_samples or focus_steps, or a smaller radius_px need less",
                        to.most));
    to.kernels.push_back(std::move(kernel));
    return static_cast<std::uint16_t>(to.kernels.size() - 1);
}

bool wants_source_kernels(const OpticsSettings& optics) {
    return optics.enabled && (optics.visibility != PupilVisibility::open || optics.focus_m > 0);
}

SourceKernels source_kernels(const Scene& scene, const Frame& frame, double clip, const Aperture& aperture,
                             const Image<Vec3f>& open, const Exec& exec) {
    SourceKernels result;
    result.most = static_cast<std::size_t>(kernels_that_fit(scene));
    result.kernels.push_back(open);
    result.choice = Image<std::uint16_t>(frame.width, frame.height);
    if (scene.optics.focus_m > 0) add_defocus(scene, frame, clip, aperture, exec, result);
    if (scene.optics.visibility != PupilVisibility::open)
        add_hidden_lamps(scene, frame, clip, aperture, exec, result);
    return result;
}

}  // namespace obscura
