// Sources are put into few classes whose patterns are computed: by what they see of the lens, or by how far
// they are out of focus.

#include "app/glare/source_kernels.h"

#include <fmt/format.h>

#include <utility>

#include "app/glare/defocus.h"
#include "app/glare/hidden_lamps.h"
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

void add_source_kernels(const Scene& scene, const LitPicture& picture, double clip, const Aperture& aperture,
                        const Exec& exec, SourceKernels& to) {
    to.choice = Image<std::uint16_t>(picture.width(), picture.height());
    if (scene.optics.focus_m > 0) add_defocus(scene, picture, clip, aperture, exec, to);
    if (scene.optics.visibility != PupilVisibility::open)
        add_hidden_lamps(scene, picture, clip, aperture, exec, to);
}

}  // namespace obscura
