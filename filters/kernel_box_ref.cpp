// What kernels read, one receiver at a time.

#include "filters/kernel_box.h"

#include <algorithm>

#include "filters/pcf_place.h"

namespace obscura::ref {
namespace {

/// First and last square of a kernel along one axis, as the map holds them; none when first > last.
struct Run {
    std::int32_t first, last;
};

Run run_of(std::int32_t first, int side, std::int32_t size, bool directional) {
    const std::int32_t last = first + side - 1;
    if (!directional) return {std::clamp(first, 0, size - 1), std::clamp(last, 0, size - 1)};
    return {std::max(first, 0), std::min(last, size - 1)};
}

void set_box(const PcfPlace& place, const PcfLight& light, int level, int at, BoxesOnLevel& boxes) {
    const Kernel kernel(place, light.side, level);
    const std::int32_t size = light.view[place.view].size >> level;
    const Run x = run_of(kernel.x0, kernel.side, size, light.directional),
              y = run_of(kernel.y0, kernel.side, size, light.directional);
    if (x.first > x.last || y.first > y.last) return;
    boxes.reading[at / 16] |= 1u << (at & 15);
    boxes.level[at] = level;
    boxes.x0[at] = x.first;
    boxes.x1[at] = x.last;
    boxes.y0[at] = y.first;
    boxes.y1[at] = y.last;
}

}  // namespace

void kernel_boxes(const SurfaceBlock& surface, const PcfLight& light, KernelBoxes& boxes) noexcept {
    for (BoxesOnLevel& kernel : boxes.kernel)
        std::fill_n(kernel.reading, block_groups, 0u);
    for (int at = 0; at < block_samples; ++at) {
        const PcfPlace place = pcf_place(surface, light, at);
        if (place.kind != PcfPlace::on_map) continue;
        boxes.view[at] = place.view;
        const Levels levels = light.filter == PcfFilter::hierarchical ? levels_of(place) : Levels{};
        set_box(place, light, levels.fine, at, boxes.kernel[0]);
        if (levels.blend != 0.0f) set_box(place, light, levels.fine + 1, at, boxes.kernel[1]);
    }
}

}  // namespace obscura::ref
