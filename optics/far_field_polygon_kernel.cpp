// The polygon transform, sixteen frequencies of a row at a time. See far_field_polygon_ref.cpp for the
// meaning of each step.

#include "optics/far_field_polygon.h"

#include "optics/field/compensated_sum.h"
#include "optics/field/phasor_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE Phasor16 times(const Phasor16& a, const Phasor16& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

OBSCURA_INLINE Phasor16 short_edge(const F64& t, const F64& middle) {
    const ReducedTurn16 r = reduced_turn(middle);
    const F32 z = r.angle * r.angle;
    const Phasor16 p = phasor(middle);
    const F32 below_one =
        select(equal(r.quarter, splat(std::int32_t{0})), cosine_less_one(z), p.re - splat(1.0f));
    const F32 s = sinc(t);
    const F32 a = to_f32(t) * splat(phasor_terms::pi);
    return {sinc_less_one(a * a) + s * below_one, s * p.im};
}

struct Direction {
    F64 u;
    double v;
    F32 unit_u, unit_v, scale;
};

OBSCURA_INLINE F64 select(const Mask& m, const F64& a, const F64& b) {
    alignas(64) double from_a[lanes], from_b[lanes];
    store(from_a, a);
    store(from_b, b);
    const std::uint32_t which = bits(m);
    for (int l = 0; l < lanes; ++l)
        from_b[l] = (which >> l & 1u) != 0 ? from_a[l] : from_b[l];
    return load(from_b);
}

OBSCURA_INLINE Direction direction_of(const F64& u, double v) {
    const F64 length = sqrt(u * u + splat(v * v)), lowest = splat(polygon_lowest);
    const Mask there = greater_equal(length, lowest);
    F64 some_u = u, some = length;
    if (!all(there)) {
        some_u = select(there, u, lowest);
        some = select(there, length, lowest);
    }
    return {some_u, v, to_f32(some_u / some), to_f32(splat(v) / some),
            to_f32(splat(1.0) / (splat(phasor_terms::two_pi) * some))};
}

OBSCURA_INLINE Phasor16 loaded(const float* u_re, const float* u_im, const float* v_re, const float* v_im,
                               std::int32_t i) {
    const std::int32_t at = lanes * i;
    return times({load(u_re + at), load(u_im + at)}, {splat(v_re[at]), splat(v_im[at])});
}

OBSCURA_INLINE Phasor16 loop_transform(const PolygonLoops& p, std::int32_t loop, const Direction& q) {
    const F32 zero = splat(0.0f), one = splat(1.0f);
    Phasor16 sum = {zero, zero}, lost = sum;
    std::int32_t last = p.begin[loop + 1] - 1;
    Phasor16 from = loaded(p.vertex_u_re, p.vertex_u_im, p.vertex_v_re, p.vertex_v_im, last);
    for (std::int32_t i = p.begin[loop]; i < p.begin[loop + 1]; ++i) {
        const double dx = p.x[i] - p.x[last], dy = p.y[i] - p.y[last];
        const F64 t = q.u * splat(dx) + splat(q.v * dy);
        const F32 turns = to_f32(t);
        const Phasor16 to = loaded(p.vertex_u_re, p.vertex_u_im, p.vertex_v_re, p.vertex_v_im, i);
        const F32 scale = splat(0.5f) / (turns * splat(phasor_terms::pi));
        Phasor16 edge = {(from.im - to.im) * scale - one, (to.re - from.re) * scale};
        const Mask is_short = less(abs(turns), splat(phasor_terms::short_of_turn));
        if (any(is_short)) {
            const double middle_x = (p.x[i] + p.x[last]) * 0.5, middle_y = (p.y[i] + p.y[last]) * 0.5;
            const Phasor16 other = short_edge(t, q.u * splat(middle_x) + splat(q.v * middle_y));
            edge = {select(is_short, other.re, edge.re), select(is_short, other.im, edge.im)};
        }
        const F32 across =
            q.unit_u * splat(static_cast<float>(dy)) - q.unit_v * splat(static_cast<float>(dx));
        add_compensated(across * edge.re, sum.re, lost.re);
        add_compensated(across * edge.im, sum.im, lost.im);
        from = to;
        last = i;
    }
    return {(sum.im * q.scale) ^ splat(-0.0f), sum.re * q.scale};
}

}  // namespace

void polygon_row(const PolygonLoops& polygon, const FrequencyRamp& ramp, int offset, double v, float* re,
                 float* im) noexcept {
    const Direction q = direction_of(ramp16(ramp, offset), v);
    Phasor16 total = {splat(0.0f), splat(0.0f)};
    for (std::int32_t loop = 0; loop < polygon.loops; ++loop) {
        const Phasor16 own = loop_transform(polygon, loop, q);
        const Phasor16 centre =
            loaded(polygon.centre_u_re, polygon.centre_u_im, polygon.centre_v_re, polygon.centre_v_im, loop);
        const Phasor16 placed = times(own, centre);
        total = {total.re + placed.re, total.im + placed.im};
    }
    store(re, total.re);
    store(im, total.im);
}

}  // namespace obscura::OBSCURA_ISA
