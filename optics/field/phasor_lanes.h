#pragma once
// Sixteen phasors. Kernel files only; see optics/field/phasor_scalar.h for the meaning of each step.

#include "core/simd.h"
#include "optics/field/phasor.h"
#include "optics/field/phasor_terms.h"

namespace obscura::OBSCURA_ISA {
namespace {

struct Phasor16 {
    F32 re, im;
};

struct ReducedTurn16 {
    F32 angle;
    I32 quarter;
};

OBSCURA_INLINE ReducedTurn16 reduced_turn(const F64& t) {
    const F64 rounder = splat(phasor_terms::rounder);
    const F64 rest = t - ((t + rounder) - rounder);
    const I32 quarter = round_to_i32(rest * splat(4.0));
    const F64 angle = (rest - to_f64(quarter) * splat(0.25)) * splat(phasor_terms::two_pi);
    return {to_f32(angle), quarter};
}

OBSCURA_INLINE F32 sine_over_angle(const F32& z) {
    using namespace phasor_terms;
    return ((z * splat(s3) + splat(s2)) * z + splat(s1)) * z + splat(1.0f);
}
OBSCURA_INLINE F32 cosine(const F32& z) {
    using namespace phasor_terms;
    return (((z * splat(c4) + splat(c3)) * z + splat(c2)) * (z * z) - z * splat(0.5f)) + splat(1.0f);
}

/// cosine - 1; and sinc - 1 of turns below short_of_turn, in z = (pi t)^2.
OBSCURA_INLINE F32 cosine_less_one(const F32& z) {
    using namespace phasor_terms;
    return ((z * splat(c4) + splat(c3)) * z + splat(c2)) * (z * z) - z * splat(0.5f);
}
OBSCURA_INLINE F32 sinc_less_one(const F32& z) {
    using namespace phasor_terms;
    return ((z * splat(s3) + splat(s2)) * z + splat(s1)) * z;
}

/// Bit 1 of `quarter`, as the sign bit of a float.
OBSCURA_INLINE F32 sign_of_half(const I32& quarter) {
    return bitcast_f32(shift_left<30>(quarter & splat(std::int32_t{2})));
}
OBSCURA_INLINE Mask is_odd(const I32& quarter) {
    return equal(quarter & splat(std::int32_t{1}), splat(std::int32_t{1}));
}

/// e^(-2 pi i t).
OBSCURA_INLINE Phasor16 phasor(const F64& t) {
    const ReducedTurn16 r = reduced_turn(t);
    const F32 z = r.angle * r.angle;
    const F32 s = r.angle * sine_over_angle(z), c = cosine(z);
    // Quarters 0 to 3: (c, -s), (-s, -c), (-c, s), (s, c).
    const Mask odd = is_odd(r.quarter);
    const F32 re = select(odd, s, c), im = select(odd, c, s);
    const I32 one = splat(std::int32_t{1}), two = splat(std::int32_t{2});
    return {re ^ sign_of_half(r.quarter + (r.quarter & one)), im ^ sign_of_half((r.quarter & two) + two)};
}

/// sin(pi t) / (pi t).
OBSCURA_INLINE F32 sinc(const F64& t) {
    const F32 nearby = to_f32(t);
    const ReducedTurn16 r = reduced_turn(t * splat(0.5));
    const F32 z = r.angle * r.angle;
    const F32 over_angle = sine_over_angle(z);
    const F32 s = select(is_odd(r.quarter), cosine(z), r.angle * over_angle) ^ sign_of_half(r.quarter);
    return select(less(abs(nearby), splat(phasor_terms::short_of_turn)), over_angle,
                  s / (nearby * splat(phasor_terms::pi)));
}

/// Integral from x0 to x1 of weight e^(-2 pi i u x) dx.
OBSCURA_INLINE Phasor16 box_transform(const F64& u, double x0, double x1, float weight) {
    const double width = x1 - x0;
    const F32 size = splat(static_cast<float>(width) * weight) * sinc(u * splat(width));
    const Phasor16 p = phasor(u * splat((x0 + x1) * 0.5));
    return {size * p.re, size * p.im};
}

/// weight e^(-2 pi i u x) at the middle x of [x0, x1).
OBSCURA_INLINE Phasor16 point_transform(const F64& u, double x0, double x1, float weight) {
    const Phasor16 p = phasor(u * splat((x0 + x1) * 0.5));
    return {splat(weight) * p.re, splat(weight) * p.im};
}

/// Derivative of sinc by t.
OBSCURA_INLINE F32 sinc_slope(const F64& t) {
    using namespace phasor_terms;
    const F32 nearby = to_f32(t);
    const F32 a = nearby * splat(pi), z = a * a;
    const F32 series = ((z * splat(d3) + splat(d2)) * z + splat(d1)) * z + splat(1.0f);
    return select(less(abs(nearby), splat(short_of_turn)), series * (a * splat(-pi / 3)),
                  (phasor(t * splat(0.5)).re - sinc(t)) / nearby);
}

/// Derivative of box_transform by u, times `step`.
OBSCURA_INLINE Phasor16 box_slope(const F64& u, double step, double x0, double x1, float weight) {
    const double width = x1 - x0, centre = (x0 + x1) * 0.5;
    const float size = static_cast<float>(width) * weight;
    const F64 t = u * splat(width);
    const F32 own = splat(size) * (splat(static_cast<float>(width * step)) * sinc_slope(t));
    const F32 turning =
        splat(size) * (splat(static_cast<float>(phasor_terms::two_pi * centre * step)) * sinc(t));
    const Phasor16 p = phasor(u * splat(centre));
    return {own * p.re + turning * p.im, own * p.im - turning * p.re};
}

/// Frequencies first + (offset + lane) step.
OBSCURA_INLINE F64 ramp16(const FrequencyRamp& ramp, int offset) {
    return splat(ramp.first) + to_f64(lane_index() + splat(std::int32_t{offset})) * splat(ramp.step);
}

/// The first `count` lanes (at most 16).
OBSCURA_INLINE void store_first(float* to, const F32& v, int count) {
    if (count >= lanes) {
        store(to, v);
        return;
    }
    alignas(64) float all[lanes];
    store(all, v);
    for (int l = 0; l < count; ++l)
        to[l] = all[l];
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
