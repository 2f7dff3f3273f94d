// Percentage-closer filtering of dense maps, one receiver and one texel at a time.

#include <algorithm>

#include "filters/pcf_place.h"
#include "filters/stored_texel.h"
#include "filters/tree_pcf.h"

namespace obscura::ref {
namespace {

float visibility_of(const PcfPlace& r, const PcfLight& light) {
    if (!r.asks()) return 0.0f;
    if (r.kind == PcfPlace::before_near) return 1.0f;
    const PcfView& view = light.view[r.view];
    const Kernel kernel(r, light.side, 0);
    const std::int32_t last = view.size - 1;
    return kernel.mean([&](int i, int j) {
        std::int32_t x = kernel.x0 + i, y = kernel.y0 + j;
        if (!light.directional) {
            x = std::clamp(x, 0, last);
            y = std::clamp(y, 0, last);
        }
        if (x < 0 || y < 0 || x > last || y > last) return true;
        return kernel.depth_at(i, j) <= stored_texel(view, x, y);
    });
}

}  // namespace

void pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept {
    if (light.view[0].tree != nullptr) {
        tree_pcf_block(surface, light, visibility);
        return;
    }
    for (int at = 0; at < block_samples; ++at)
        visibility[at] = visibility_of(pcf_place(surface, light, at), light);
}

}  // namespace obscura::ref
