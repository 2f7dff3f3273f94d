// Percentage-closer filtering of trees, one receiver at a time.

#include "filters/tree_pcf.h"

#include "filters/tree_taps.h"

namespace obscura::ref {
namespace {

/// mean(taps) over the levels that the filter asks for.
template <class Mean>
float visibility_of(const PcfPlace& r, const PcfLight& light, Mean&& mean) {
    if (!r.asks()) return 0.0f;
    if (r.kind == PcfPlace::before_near) return 1.0f;
    return filtered(r, light, [&](int level) {
        const Kernel kernel(r, light.side, level);
        return mean(TreeTaps{kernel, *light.view[r.view].tree, !light.directional});
    });
}

}  // namespace

void tree_pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept {
    TreePath path[6];
    for (int view = 0; view < light.views; ++view) {
        const TreeCode& tree = *light.view[view].tree;
        with_code(tree, [&]<class Code>(Code) { start_path<Code>(tree, path[view]); });
    }
    for (int at = 0; at < block_samples; ++at) {
        const PcfPlace r = pcf_place(surface, light, at);
        visibility[at] = with_code(*light.view[r.view].tree, [&]<class Code>(Code) {
            return visibility_of(r, light,
                                 [&](const TreeTaps& taps) { return shared_mean<Code>(taps, path[r.view]); });
        });
    }
}

void naive_tree_pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept {
    for (int at = 0; at < block_samples; ++at) {
        const PcfPlace r = pcf_place(surface, light, at);
        int steps = 0;
        visibility[at] = with_code(*light.view[r.view].tree, [&]<class Code>(Code) {
            return visibility_of(r, light,
                                 [&](const TreeTaps& taps) { return naive_mean<Code>(taps, steps); });
        });
    }
}

}  // namespace obscura::ref
