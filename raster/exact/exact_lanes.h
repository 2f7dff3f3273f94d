#pragma once
// Sixteen samples against the casters of a view. Kernel files only; the meaning of each step is in
// exact_ref.cpp.
//
// Samples come in an order in which neighbours lie close together on the light's grid. Boxes are asked for
// sixteen of their children at once: first for sixteen bunches of samples together, then for each bunch among
// what is left.

#include "core/simd_vec.h"
#include "raster/exact/exact.h"

namespace obscura::OBSCURA_ISA {
namespace {

constexpr int bunches = 16;

OBSCURA_INLINE std::int32_t least(std::int32_t a, std::int32_t b) {
    return a < b ? a : b;
}
OBSCURA_INLINE std::int32_t most(std::int32_t a, std::int32_t b) {
    return a > b ? a : b;
}
OBSCURA_INLINE float least(float a, float b) {
    return a < b ? a : b;
}
OBSCURA_INLINE float most(float a, float b) {
    return a > b ? a : b;
}

/// What samples of one view lie in, on its grid, and the deepest of them.
struct Extent {
    std::int32_t x_low, x_high, y_low, y_high;
    float z_high;
};

/// Sixteen samples of one view, or fewer: lanes that are not open repeat one that is.
struct Bunch {
    alignas(64) std::int32_t x[16], y[16], face[16];
    alignas(64) float z[16];
    alignas(64) double px[16], py[16], pz[16];  ///< world space
    alignas(64) double lowest[16];              ///< height above a plane below which it is behind it
    Extent extent;
    float z_low;
    float middle[3], half[3];  ///< of what the samples span, metres, relative to the eye
    float rounding;            ///< the least that is uncertain of one
    double near;               ///< height above a plane below which no snapping takes any of them
    std::int32_t point[16];
    std::uint32_t open;  ///< lanes that nothing has darkened yet
    bool one_face;       ///< all lanes have the first one's
};

/// What follows from the samples of a bunch, all of whose lanes are filled; `open`: those that are some.
OBSCURA_INLINE void finish_bunch(const ExactLight& light, const F32& rounding, std::uint32_t open,
                                 Bunch& to) {
    store(to.lowest, splat(0.0) - to_f64(rounding));
    const I32 x = load(to.x), y = load(to.y), face = load(to.face);
    const F32 z = load(to.z);
    to.extent = {lowest(x), highest(x), lowest(y), highest(y), highest(z)};
    to.z_low = lowest(z);
    to.rounding = lowest(rounding);
    float reach = 0;
    const double* const axis[3] = {to.px, to.py, to.pz};
    for (int k = 0; k < 3; ++k) {
        const F32 p = to_f32(load(axis[k]) - splat(light.eye[k]));
        const float low = lowest(p), high = highest(p);
        to.middle[k] = 0.5f * (low + high);
        // Half, and as much again as its rounding may be.
        to.half[k] = 0.5f * (high - low) + 0x1p-22f * most(high, -low);
        reach += most(high, -low);
    }
    to.near =
        -1.001 * static_cast<double>(highest(rounding) +
                                     (light.snapping_m + light.snapping_per_m * reach) / exact_least_cosine);
    to.open = open;
    to.one_face = all(equal(face, splat(to.face[0])));
}

/// Which of sixteen boxes may hold what darkens something in `e`.
OBSCURA_INLINE std::uint32_t overlapping(const CasterBoxes& boxes, const Extent& e) {
    return bits(
        less_equal(load(boxes.x_low), splat(e.x_high)) & less_equal(splat(e.x_low), load(boxes.x_high)) &
        less_equal(load(boxes.y_low), splat(e.y_high)) & less_equal(splat(e.y_low), load(boxes.y_high)) &
        less_equal(load(boxes.z_low), splat(e.z_high)));
}

/// Calls visit(group of boxes, child) for every triangle whose box inside_of(boxes) names, as it does the
/// boxes around it, until it returns false.
template <class Inside, class Visit>
OBSCURA_INLINE void walk(const ExactView& view, std::int64_t& groups, Inside&& inside_of, Visit&& visit) {
    struct Entry {
        std::int32_t level;
        std::uint32_t group;
    };
    Entry stack[16 * most_caster_levels];
    int top = 0;
    stack[top++] = {view.levels - 1, 0};
    while (top > 0) {
        const Entry at = stack[--top];
        ++groups;
        const CasterBoxes& boxes = view.boxes[at.level][at.group];
        std::uint32_t inside = inside_of(boxes);
        if (at.level == 0) {
            for (; inside != 0; inside &= inside - 1) {
                if (!visit(boxes, 16 * at.group, __builtin_ctz(inside))) return;
            }
            continue;
        }
        // Last first, so that the first is on top.
        while (inside != 0) {
            const int k = 31 - __builtin_clz(inside);
            inside &= ~(1u << k);
            stack[top++] = {at.level - 1, 16 * at.group + static_cast<std::uint32_t>(k)};
        }
    }
}

/// The same for those that overlap e.
template <class Visit>
OBSCURA_INLINE void walk(const ExactView& view, const Extent& e, std::int64_t& groups, Visit&& visit) {
    walk(
        view, groups, [&](const CasterBoxes& boxes) { return overlapping(boxes, e); }, visit);
}

OBSCURA_INLINE Extent united(const Extent& a, const Extent& b) {
    return {least(a.x_low, b.x_low), most(a.x_high, b.x_high), least(a.y_low, b.y_low),
            most(a.y_high, b.y_high), most(a.z_high, b.z_high)};
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
