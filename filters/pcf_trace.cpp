// One lookup with everything it saw.

#include <algorithm>

#include "filters/shadow_lookup.h"
#include "filters/stored_texel.h"
#include "filters/tree_taps.h"

namespace obscura::ref {
namespace {

/// The taps of a kernel, one after the other; returns their mean.
template <class Stored>
float record_taps(const Kernel& kernel, bool clamp, std::int32_t last, Stored&& stored,
                  std::vector<PcfTap>& taps) {
    return kernel.mean([&](int i, int j) {
        PcfTap tap;
        tap.x = clamp ? std::clamp(kernel.x0 + i, 0, last) : kernel.x0 + i;
        tap.y = clamp ? std::clamp(kernel.y0 + j, 0, last) : kernel.y0 + j;
        tap.level = kernel.level;
        tap.weight = tap_weight(i, kernel.side, kernel.fx);
        tap.receiver = kernel.depth_at(i, j);
        tap.inside = tap.x >= 0 && tap.y >= 0 && tap.x <= last && tap.y <= last;
        if (tap.inside) {
            tap.stored = stored(tap.x, tap.y);
            tap.lit = tap.receiver <= tap.stored;
        }
        taps.push_back(tap);
        return tap.lit;
    });
}

template <class Code>
PcfSteps count_steps(const PcfPlace& r, const PcfLight& light) {
    const TreeCode& tree = *light.view[r.view].tree;
    PcfSteps steps;
    TreePath path;
    start_path<Code>(tree, path);
    filtered(r, light, [&](int level) {
        const Kernel kernel(r, light.side, level);
        const TreeTaps taps{kernel, tree, !light.directional};
        naive_mean<Code>(taps, steps.naive);
        return shared_mean<Code>(taps, path);
    });
    steps.shared = path.steps;
    return steps;
}

PcfSteps steps_of(const PcfPlace& r, const PcfLight& light) {
    if (!r.asks() || r.kind == PcfPlace::before_near || light.view[0].tree == nullptr) return {};
    return with_code(*light.view[r.view].tree, [&]<class Code>(Code) { return count_steps<Code>(r, light); });
}

}  // namespace

PcfTrace trace_pcf(const SurfaceBlock& surface, const PcfLight& light, int at) {
    PcfTrace trace;
    const PcfPlace r = pcf_place(surface, light, at);
    if (!r.asks()) return trace;
    trace.view = r.view;
    trace.X = r.X;
    trace.Y = r.Y;
    trace.depth = r.depth;
    trace.tap_texels = r.tap_texels;
    if (r.kind == PcfPlace::before_near) {
        trace.visibility = 1.0f;
        return trace;
    }
    trace.looked_up = true;
    const PcfView& view = light.view[r.view];
    trace.visibility = filtered(r, light, [&](int level) {
        const Kernel kernel(r, light.side, level);
        const std::int32_t last = (view.size >> level) - 1;
        if (view.tree == nullptr) {
            return record_taps(
                kernel, !light.directional, last,
                [&](std::int32_t x, std::int32_t y) { return stored_texel(view, x, y); }, trace.taps);
        }
        return with_code(*view.tree, [&]<class Code>(Code) {
            const TreeTaps taps{kernel, *view.tree, !light.directional};
            TreePath path;
            start_path<Code>(*view.tree, path);
            return record_taps(
                kernel, !light.directional, last,
                [&](std::int32_t x, std::int32_t y) { return value_along<Code>(taps, x, y, path); },
                trace.taps);
        });
    });
    trace.steps = steps_of(r, light);
    return trace;
}

PcfSteps pcf_steps(const SurfaceBlock& surface, const PcfLight& light, int at) {
    return steps_of(pcf_place(surface, light, at), light);
}

}  // namespace obscura::ref
