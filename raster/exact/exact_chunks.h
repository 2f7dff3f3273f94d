#pragma once
// Points as they come, sixteen bunches of sixteen at a time: those that stand together before the light are
// answered as they are, others wait for an order of their own. Kernel files only.

#include "raster/exact/exact_receivers.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// How much larger than its share of the box of all a bunch's may be.
constexpr double most_of_share = 3;

OBSCURA_INLINE double area(const Extent& e) {
    return (1.0 + e.x_high - e.x_low) * (1.0 + e.y_high - e.y_low);
}

/// Samples that wait for an order of their own.
OBSCURA_INLINE void append(const Bunch& from, std::int32_t view, ExactSamples& to) {
    std::int32_t n = to.count;
    for (std::uint32_t left = from.open; left != 0; left &= left - 1, ++n) {
        const int k = __builtin_ctz(left);
        to.x[n] = from.x[k];
        to.y[n] = from.y[k];
        to.z[n] = from.z[k];
        to.rounding[n] = static_cast<float>(-from.lowest[k]);
        to.point[n] = static_cast<std::uint32_t>(from.point[k]);
        to.view[n] = static_cast<std::uint8_t>(view);
    }
    to.count = n;
}

/// Leaves those of n bunches that stand together before the light: neighbours on a surface do, whose boxes
/// share out the box of all of them; leaves and what is seen between them do not, and their samples wait.
/// Returns how many are left.
OBSCURA_INLINE int keep_together(Bunch* bunch, int n, std::int32_t view, ExactSamples& samples) {
    Extent all = bunch[0].extent;
    for (int b = 1; b < n; ++b)
        all = united(all, bunch[b].extent);
    const double largest = area(all) * most_of_share / n;
    int left = 0;
    for (int b = 0; b < n; ++b) {
        if (area(bunch[b].extent) > largest) {
            append(bunch[b], view, samples);
        } else {
            if (left != b) bunch[left] = bunch[b];
            ++left;
        }
    }
    return left;
}

/// Puts into `lit` all that face the light, or let it through, and calls answer(view, its index, bunches,
/// how many) with those that stand together; the others become samples.
template <class Answer>
OBSCURA_INLINE void locate_chunks(const ExactPoints& points, const ExactLight& light, ExactSamples& samples,
                                  std::uint32_t* lit, Answer&& answer) {
    samples.count = 0;
    Bunch bunch[bunches];
    for (std::int32_t chunk = 0; chunk < points.count; chunk += lanes * bunches) {
        const std::int32_t end = least(chunk + lanes * bunches, points.count);
        std::uint32_t views = 0;
        for (std::int32_t at = chunk; at < end; at += lanes) {
            lit[at / 16] = 0;
            if (points.covered[at / 16] == 0) continue;
            const Receivers r = receivers(points, light, at);
            lit[at / 16] = r.asking;
            for (std::int32_t v = 0; v < light.views; ++v)
                views |= static_cast<std::uint32_t>((r.asking & bits(equal(r.view, splat(v)))) != 0) << v;
        }
        for (; views != 0; views &= views - 1) {
            const std::int32_t v = __builtin_ctz(views);
            const ExactView& view = light.view[v];
            if (view.levels == 0) continue;
            int n = 0;
            for (std::int32_t at = chunk; at < end; at += lanes) {
                if (points.covered[at / 16] == 0) continue;
                const Receivers r = receivers(points, light, at);
                const std::uint32_t of_view = r.asking & bits(equal(r.view, splat(v)));
                if (of_view == 0) continue;
                const Located place = located(light, view, r.x, r.y, r.z, r.p, r.g);
                const std::uint32_t open = of_view & place.looks;
                if (open != 0) fill_bunch(points, light, place, at, open, bunch[n++]);
            }
            if (n > 0) n = keep_together(bunch, n, v, samples);
            if (n > 0) answer(view, v, bunch, n);
        }
    }
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
