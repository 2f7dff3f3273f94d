// The polygon transform, one frequency at a time. See far_field_polygon.cpp for the formulas.

#include <cmath>

#include "optics/far_field_polygon.h"
#include "optics/field/compensated_sum.h"
#include "optics/field/phasor_scalar.h"

namespace obscura::ref {
namespace {

Phasor times(const Phasor& a, const Phasor& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/// sinc(t) e^(-2 pi i middle) - 1, accurate where it is small.
Phasor short_edge(double t, double middle) {
    const ReducedTurn r = reduced_turn(middle);
    const float z = r.angle * r.angle;
    const Phasor p = phasor(middle);
    const float below_one = r.quarter == 0 ? cosine_less_one(z) : p.re - 1.0f;
    const float s = sinc(t);
    const float a = static_cast<float>(t) * phasor_terms::pi;
    return {sinc_less_one(a * a) + s * below_one, s * p.im};
}

/// A frequency, its direction and 1 / (2 pi |q|).
struct Direction {
    double u, v;
    float unit_u, unit_v, scale;
};

Direction direction_of(double u, double v) {
    const double length = std::sqrt(u * u + v * v);
    const bool none = !(length >= polygon_lowest);
    const double some_u = none ? polygon_lowest : u, some = none ? polygon_lowest : length;
    return {some_u, v, static_cast<float>(some_u / some), static_cast<float>(v / some),
            static_cast<float>(1.0 / (phasor_terms::two_pi * some))};
}

Phasor loop_transform(const PolygonLoops& p, std::int32_t loop, const Direction& q, int lane) {
    const auto vertex = [&](std::int32_t i) {
        const std::int32_t at = 16 * i + lane;
        return times({p.vertex_u_re[at], p.vertex_u_im[at]}, {p.vertex_v_re[16 * i], p.vertex_v_im[16 * i]});
    };
    Phasor sum, lost;
    std::int32_t last = p.begin[loop + 1] - 1;
    Phasor from = vertex(last);
    for (std::int32_t i = p.begin[loop]; i < p.begin[loop + 1]; ++i) {
        const double dx = p.x[i] - p.x[last], dy = p.y[i] - p.y[last];
        const double t = q.u * dx + q.v * dy;
        const float turns = static_cast<float>(t);
        const Phasor to = vertex(i);
        Phasor edge;
        if ((turns < 0.0f ? -turns : turns) < phasor_terms::short_of_turn) {
            const double middle_x = (p.x[i] + p.x[last]) * 0.5, middle_y = (p.y[i] + p.y[last]) * 0.5;
            edge = short_edge(t, q.u * middle_x + q.v * middle_y);
        } else {
            const float scale = 0.5f / (turns * phasor_terms::pi);
            edge = {(from.im - to.im) * scale - 1.0f, (to.re - from.re) * scale};
        }
        const float across = q.unit_u * static_cast<float>(dy) - q.unit_v * static_cast<float>(dx);
        add_compensated(across * edge.re, sum.re, lost.re);
        add_compensated(across * edge.im, sum.im, lost.im);
        from = to;
        last = i;
    }
    return {-(sum.im * q.scale), sum.re * q.scale};
}

}  // namespace

void polygon_row(const PolygonLoops& polygon, const FrequencyRamp& ramp, int offset, double v, float* re,
                 float* im) noexcept {
    for (int l = 0; l < 16; ++l) {
        const Direction q = direction_of(ramp.first + (offset + l) * ramp.step, v);
        Phasor total;
        for (std::int32_t loop = 0; loop < polygon.loops; ++loop) {
            const Phasor own = loop_transform(polygon, loop, q, l);
            const std::int32_t at = 16 * loop;
            const Phasor centre = times({polygon.centre_u_re[at + l], polygon.centre_u_im[at + l]},
                                        {polygon.centre_v_re[at], polygon.centre_v_im[at]});
            const Phasor placed = times(own, centre);
            total = {total.re + placed.re, total.im + placed.im};
        }
        re[l] = total.re;
        im[l] = total.im;
    }
}

}  // namespace obscura::ref
