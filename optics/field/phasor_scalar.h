#pragma once
// One phasor at a time: what a lane of optics/field/phasor_lanes.h does, for the ref kernels.

#include "optics/field/phasor_terms.h"

namespace obscura {

struct Phasor {
    float re = 0, im = 0;
};

inline double nearest_integer(double t) {
    return (t + phasor_terms::rounder) - phasor_terms::rounder;
}

/// t = (whole turns) + quarter / 4 + angle / (2 pi), |angle| <= pi / 4.
struct ReducedTurn {
    float angle = 0;
    int quarter = 0;  ///< -2 to 2
};

inline ReducedTurn reduced_turn(double t) {
    const double rest = t - nearest_integer(t);
    const double quarter = nearest_integer(rest * 4.0);
    const double angle = (rest - quarter * 0.25) * phasor_terms::two_pi;
    return {static_cast<float>(angle), static_cast<int>(quarter)};
}

/// sine / angle and cosine of a reduced angle.
inline float sine_over_angle(float z) {
    using namespace phasor_terms;
    return ((z * s3 + s2) * z + s1) * z + 1.0f;
}
inline float cosine(float z) {
    using namespace phasor_terms;
    return (((z * c4 + c3) * z + c2) * (z * z) - z * 0.5f) + 1.0f;
}

/// cosine - 1; and sinc - 1 of turns below short_of_turn, in z = (pi t)^2. Accurate where they are small.
inline float cosine_less_one(float z) {
    using namespace phasor_terms;
    return ((z * c4 + c3) * z + c2) * (z * z) - z * 0.5f;
}
inline float sinc_less_one(float z) {
    using namespace phasor_terms;
    return ((z * s3 + s2) * z + s1) * z;
}

/// e^(-2 pi i t).
inline Phasor phasor(double t) {
    const ReducedTurn r = reduced_turn(t);
    const float z = r.angle * r.angle;
    const float s = r.angle * sine_over_angle(z), c = cosine(z);
    switch (r.quarter & 3) {
        case 0:
            return {c, -s};
        case 1:
            return {-s, -c};
        case 2:
            return {-c, s};
        default:
            return {s, c};
    }
}

/// sin(pi t) / (pi t).
inline float sinc(double t) {
    const float nearby = static_cast<float>(t);
    const ReducedTurn r = reduced_turn(t * 0.5);
    const float z = r.angle * r.angle;
    const float over_angle = sine_over_angle(z);
    if ((nearby < 0.0f ? -nearby : nearby) < phasor_terms::short_of_turn) return over_angle;
    const float s = (r.quarter & 1) != 0 ? cosine(z) : r.angle * over_angle;
    return ((r.quarter & 2) != 0 ? -s : s) / (nearby * phasor_terms::pi);
}

/// Integral from x0 to x1 of weight e^(-2 pi i u x) dx.
inline Phasor box_transform(double u, double x0, double x1, float weight) {
    const double width = x1 - x0;
    const float size = (static_cast<float>(width) * weight) * sinc(u * width);
    const Phasor p = phasor(u * ((x0 + x1) * 0.5));
    return {size * p.re, size * p.im};
}

/// weight e^(-2 pi i u x) at the middle x of [x0, x1).
inline Phasor point_transform(double u, double x0, double x1, float weight) {
    const Phasor p = phasor(u * ((x0 + x1) * 0.5));
    return {weight * p.re, weight * p.im};
}

/// Derivative of sinc by t.
inline float sinc_slope(double t) {
    using namespace phasor_terms;
    const float nearby = static_cast<float>(t);
    const float a = nearby * pi, z = a * a;
    if ((nearby < 0.0f ? -nearby : nearby) < short_of_turn)
        return (((z * d3 + d2) * z + d1) * z + 1.0f) * (a * (-pi / 3));
    return (phasor(t * 0.5).re - sinc(t)) / nearby;
}

/// Derivative of box_transform by u, times `step`.
inline Phasor box_slope(double u, double step, double x0, double x1, float weight) {
    const double width = x1 - x0, centre = (x0 + x1) * 0.5;
    const float size = static_cast<float>(width) * weight;
    const float own = size * (static_cast<float>(width * step) * sinc_slope(u * width));
    const float turning = size * (static_cast<float>(phasor_terms::two_pi * centre * step) * sinc(u * width));
    const Phasor p = phasor(u * centre);
    return {own * p.re + turning * p.im, own * p.im - turning * p.re};
}

}  // namespace obscura
