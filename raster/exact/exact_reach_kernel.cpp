// Which samples a light with a size may reach, and how wide its penumbrae are, sixteen at a time. See
// exact_soft_ref.cpp for the meaning of each step.

#include "raster/exact/exact_gather.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// How far before a sample of the bunch the triangle lies on the way to the light, at most, metres; negative
/// when no part of the light has it before any.
OBSCURA_INLINE float distance_before(const CasterTriangle& t, float z_low, const ExactLight& light,
                                     const ExactSpread& spread, int view, const Bunch& s) {
    if (s.one_face && static_cast<std::int32_t>(t.face) == s.face[0]) return -1;
    const float depth = s.extent.z_high - z_low;
    if (exact_outside(t, s.extent.x_low, s.extent.x_high, s.extent.y_low, s.extent.y_high,
                      exact_steps(spread, view, depth))) {
        return -1;
    }
    const F64 height =
        (splat(t.n[0]) * load(s.px) + splat(t.n[1]) * load(s.py)) + (splat(t.n[2]) * load(s.pz) + splat(t.d));
    alignas(64) double above[16];
    store(above, height);
    float distance = -1;
    std::uint32_t left = s.open & ~bits(equal(load(s.face), splat(static_cast<std::int32_t>(t.face))));
    for (; left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        const double p[3] = {s.px[k], s.py[k], s.pz[k]};
        const float d = exact_distance(t, light, spread, depth, p, above[k], s.lowest[k]);
        distance = distance < d ? d : distance;
    }
    return distance;
}

}  // namespace

void exact_reach(const ExactPoints& points, const ExactLight& middle, const ExactSpread& spread,
                 ExactSamples& samples) noexcept {
    samples.count = 0;
    for (std::int32_t at = 0; at < points.count; at += lanes) {
        if (points.covered[at / 16] == 0) continue;
        const Receivers r = receivers(points, middle, at);
        std::uint32_t asking = r.asking;
        if (middle.directional) {
            const F32 facing = dot(r.g, splat3(middle.to_light));
            asking |= points.covered[at / 16] & bits(less(splat(exact_facing(spread)), facing));
        }
        for (std::int32_t v = 0; v < middle.views; ++v) {
            std::uint32_t left = asking & bits(equal(r.view, splat(v)));
            if (left == 0) continue;
            const Located place = located(middle, middle.view[v], r.x, r.y, r.z, r.p, r.g, exact_beyond);
            if (!middle.directional) left &= place.looks;
            add_samples(place, at, left, v, samples);
        }
    }
}

void exact_widest(const ExactPoints& points, const ExactLight& middle, const ExactSpread& spread,
                  const ExactSamples& samples, const std::uint32_t* order, float stop_px, float& widest_px,
                  ExactCounts& counts) noexcept {
    widest_px = 0;
    Gathered g;
    std::int32_t next = 0;
    while (next < samples.count) {
        const std::uint8_t v = samples.view[order[next]];
        int members = 1;
        while (members < lanes && next + members < samples.count && samples.view[order[next + members]] == v)
            ++members;
        gather(points, middle, samples, order + next, members, g);
        next += members;
        const ExactView& view = middle.view[v];
        if (view.levels == 0 || g.is_far) continue;
        float px = 0;
        walk_reach(view, g.bunch.extent, spread, v, counts.groups, [&](std::uint32_t i, float z_low) {
            ++counts.triangles;
            const float before = distance_before(view.triangles[i], z_low, middle, spread, v, g.bunch);
            const float wide = before > 0 ? exact_penumbra_px(middle, spread, g.bunch.middle, before) : 0.0f;
            px = px < wide ? wide : px;
            return px < stop_px;
        });
        widest_px = widest_px < px ? px : widest_px;
    }
    counts.samples += samples.count;
}

}  // namespace obscura::OBSCURA_ISA
