#pragma once
// Samples in an order of their own, as bunches of sixteen neighbours on the light's grid. Kernel files only.

#include "raster/exact/exact_triangle.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// `n` samples of one view, from order[0] on.
OBSCURA_INLINE void gather_bunch(const ExactPoints& points, const ExactLight& light,
                                 const ExactSamples& samples, const std::uint32_t* order, int n, Bunch& to) {
    alignas(64) float rounding[16];
    for (int k = 0; k < 16; ++k) {
        const std::uint32_t i = order[k < n ? k : 0], at = samples.point[i];
        to.x[k] = samples.x[i];
        to.y[k] = samples.y[i];
        to.z[k] = samples.z[i];
        rounding[k] = samples.rounding[i];
        to.point[k] = static_cast<std::int32_t>(at);
        to.face[k] = static_cast<std::int32_t>(points.face[at]);
        to.px[k] = points.px[at];
        to.py[k] = points.py[at];
        to.pz[k] = points.pz[at];
    }
    finish_bunch(light, load(rounding), n >= 16 ? 0xffffu : (1u << n) - 1u, to);
}

/// As many bunches as there is room for, of one view, from place `next` of the order on, which is moved past
/// them. All but the last are full. Returns how many.
OBSCURA_INLINE int gather_bunches(const ExactPoints& points, const ExactLight& light,
                                  const ExactSamples& samples, const std::uint32_t* order, std::int32_t& next,
                                  Bunch* bunch) {
    const std::uint8_t view = samples.view[order[next]];
    int n = 0;
    for (; n < bunches && next < samples.count && samples.view[order[next]] == view; ++n) {
        int members = 1;
        while (members < lanes && next + members < samples.count &&
               samples.view[order[next + members]] == view)
            ++members;
        gather_bunch(points, light, samples, order + next, members, bunch[n]);
        next += members;
    }
    return n;
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
