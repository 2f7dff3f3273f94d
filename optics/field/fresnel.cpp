// Fresnel integrals to double precision.
//
// The auxiliary function is an integral of a Gaussian over a simple pole,
//
//     g(t) + i f(t) = sqrt(u / 2) / pi * integral over the real line of e^(-v^2) / (v^2 - i u) dv,
//     u = pi t^2 / 2,
//
// which the midpoint rule sums to all digits as long as the pole, at distance sqrt(u / 2) from the real line,
// is far from it in units of the step: M. Alazah, S. N. Chandler-Wilde, S. La Porte: Computing Fresnel
// integrals via modified trapezium rules, Numerische Mathematik 128, 2014. They keep one step and correct for
// the pole; we take the power series where it would matter, so nothing needs correcting and every term of the
// sum is positive, which keeps the relative accuracy for t -> infinity.

#include "optics/field/fresnel.h"

#include <cmath>

#include "core/double_double.h"
#include "core/error.h"
#include "core/num.h"

namespace obscura {
namespace {

constexpr double half_pi = 0.5 * num::pi;
constexpr double series_below = 1.8, coarse_nodes_from = 3.4;
/// Beyond this t the integral differs from its limit by less than rounding does.
constexpr double limit_from = 1e17;

FresnelValue times(FresnelValue a, FresnelValue b) {
    return {a.c * b.c - a.s * b.s, a.c * b.s + a.s * b.c};
}

FresnelValue unit(double radians) {
    return {num::cos(radians), num::sin(radians)};
}

/// e^(2 pi i (hi + lo)): whole turns are taken off exactly.
FresnelValue unit_of_turns(Dd turns) {
    const double fraction = (turns.hi - std::floor(turns.hi)) + turns.lo;
    return unit(2 * num::pi * (fraction > 0.5 ? fraction - 1 : fraction));
}

/// Midpoint rule for a Gaussian of exponent -v^2 on v > 0, up to where it falls below 1e-16.
template <int count>
struct GaussianNodes {
    double square[count], weight[count];
    double step;
    explicit GaussianNodes(double step_) : step(step_) {
        for (int k = 0; k < count; ++k) {
            const double v = (k + 0.5) * step;
            square[k] = v * v;
            weight[k] = num::exp(-v * v);
        }
    }
    /// Sum over the whole line of step e^(-v^2) / (v^2 - i u).
    FresnelValue sum(double u) const {
        double re = 0, im = 0;
        for (int k = 0; k < count; ++k) {
            const double w = weight[k] / (square[k] * square[k] + u * u);
            re += w * square[k];
            im += w * u;
        }
        return {2 * step * re, 2 * step * im};
    }
};

/// sum over n of (i u)^n / (n! (2 n + 1)), so that C + i S = t times it.
FresnelValue power_series(double u) {
    FresnelValue sum{1, 0};
    double term = 1;
    for (int n = 1; n < 60; ++n) {
        term *= u / n;
        const double part = term / (2 * n + 1);
        if (n > 1 && part < 1e-18) break;  // not n = 1, the whole of S where t is tiny
        switch (n & 3) {
            case 0:
                sum.c += part;
                break;
            case 1:
                sum.s += part;
                break;
            case 2:
                sum.c -= part;
                break;
            default:
                sum.s -= part;
        }
    }
    return sum;
}

/// For t >= series_below.
FresnelValue auxiliary_by_nodes(double t) {
    static const GaussianNodes<23> fine(0.27);
    static const GaussianNodes<13> coarse(0.48);
    const double u = half_pi * t * t;
    const FresnelValue sum = t < coarse_nodes_from ? fine.sum(u) : coarse.sum(u);
    const double scale = 0.5 * t / std::sqrt(num::pi);  // sqrt(u / 2) / pi
    return {scale * sum.c, scale * sum.s};
}

/// For t >= 0 whose phase pi t^2 / 2 is `turns` turns.
FresnelValue integral_with_phase(double t, Dd turns) {
    if (t < series_below) {
        const FresnelValue sum = power_series(half_pi * t * t);
        return {t * sum.c, t * sum.s};
    }
    const FresnelValue tail = times(auxiliary_by_nodes(t), unit_of_turns(turns));
    return {0.5 - tail.c, 0.5 - tail.s};
}

FresnelValue with_sign_of(double t, FresnelValue v) {
    return t < 0 ? FresnelValue{-v.c, -v.s} : v;
}

}  // namespace

FresnelValue fresnel_integral(double t) {
    const double size = std::fabs(t);
    if (size > limit_from) return with_sign_of(t, {0.5, 0.5});
    const Dd square = two_product(size, size);
    return with_sign_of(t, integral_with_phase(size, {0.25 * square.hi, 0.25 * square.lo}));
}

FresnelValue fresnel_at(double turns, double d) {
    const double size = 2 * std::fabs(d) * std::sqrt(turns);
    if (size > limit_from) return with_sign_of(d, {0.5, 0.5});
    return with_sign_of(d, integral_with_phase(size, two_product(d, d) * turns));
}

FresnelValue fresnel_auxiliary(double t) {
    CHECK(t >= 0);
    if (t > limit_from) return {0, 1 / (num::pi * t)};
    if (t >= series_below) return auxiliary_by_nodes(t);
    const double u = half_pi * t * t;
    const FresnelValue sum = power_series(u);
    return times({0.5 - t * sum.c, 0.5 - t * sum.s}, unit(-u));
}

FresnelValue fresnel_integral_boersma(double t) {
    // Boersma's sum approximates the conjugate: integral of e^(-i y) / sqrt(2 pi y) dy from 0 to pi t^2 / 2.
    static constexpr double near_re[] = {1.595769140, -0.000001702, -6.808568854, -0.000576361,
                                         6.920691902, -0.016898657, -3.050485660, -0.075752419,
                                         0.850663781, -0.025639041, -0.150230960, 0.034404779};
    static constexpr double near_im[] = {-0.000000033, 4.255387524, -0.000092810, -7.780020400,
                                         -0.009520895, 5.075161298, -0.138341947, -1.363729124,
                                         -0.403349276, 0.702222016, -0.216195929, 0.019547031};
    static constexpr double far_re[] = {0,           -0.024933975, 0.000003936,  0.005770956,
                                        0.000689892, -0.009497136, 0.011948809,  -0.006748873,
                                        0.000246420, 0.002102967,  -0.001217930, 0.000233939};
    static constexpr double far_im[] = {0.199471140,  0.000000023, -0.009351341, 0.000023006,
                                        0.004851466,  0.001903218, -0.017122914, 0.029064067,
                                        -0.027928955, 0.016497308, -0.005598515, 0.000838386};
    const double size = std::fabs(t);
    if (size > limit_from) return with_sign_of(t, {0.5, 0.5});
    const double y = half_pi * size * size;
    const bool is_near = y < 4;
    const double q = is_near ? y / 4 : 4 / y;
    FresnelValue sum;
    for (int n = 11; n >= 0; --n) {
        sum.c = sum.c * q + (is_near ? near_re : far_re)[n];
        sum.s = sum.s * q + (is_near ? near_im : far_im)[n];
    }
    const double root = std::sqrt(q);
    const Dd square = two_product(size, size);
    const FresnelValue phase = unit_of_turns({0.25 * square.hi, 0.25 * square.lo});
    // Conjugate of e^(-i y) root sum.
    const FresnelValue v = times(phase, {root * sum.c, -root * sum.s});
    return with_sign_of(t, is_near ? v : FresnelValue{0.5 + v.c, 0.5 + v.s});
}

namespace {

/// Eight-point Gauss-Legendre over [0, length].
FresnelValue chirp_by_gauss(double a, double b, double length) {
    static constexpr double node[] = {0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                                      0.96028985649753623168};
    static constexpr double weight[] = {0.36268378337836198297, 0.31370664587788728734,
                                        0.22238103445337447054, 0.10122853629037625915};
    FresnelValue sum;
    for (int k = 0; k < 4; ++k) {
        for (const double side : {-1.0, 1.0}) {
            const double x = 0.5 * length * (1 + side * node[k]);
            const FresnelValue v = unit(x * (a + b * x));
            sum.c += weight[k] * v.c;
            sum.s += weight[k] * v.s;
        }
    }
    return {0.5 * length * sum.c, 0.5 * length * sum.s};
}

/// Integral of e^(i a x) over [0, length].
FresnelValue wave_integral(double a, double length) {
    const double half = 0.5 * a * length;
    const double size = half == 0 ? length : length * num::sin(half) / half;
    const FresnelValue v = unit(half);
    return {size * v.c, size * v.s};
}

}  // namespace

FresnelValue chirp_integral(double a, double b, double length) {
    CHECK(b >= 0 && length >= 0);
    if (std::fabs(a) * length + 2 * b * length * length < 2) return chirp_by_gauss(a, b, length);
    if (b * length * length < 1e-17) return wave_integral(a, length);
    // Both ends as arguments of the Fresnel integrals; the lower one belongs to x = 0.
    const double root = std::sqrt(2 * num::pi * b);
    const double t0 = a / root, t1 = (a + 2 * b * length) / root;
    const FresnelValue low = with_sign_of(t0, fresnel_auxiliary(std::fabs(t0)));
    const FresnelValue high =
        times(with_sign_of(t1, fresnel_auxiliary(std::fabs(t1))), unit(length * (a + b * length)));
    FresnelValue sum{low.c - high.c, low.s - high.s};
    if (t0 < 0 && t1 >= 0) {  // the phase is stationary inside: a limit of either sign on each side
        const FresnelValue middle = times({1, 1}, unit(-0.25 * a / b * a));
        sum.c += middle.c;
        sum.s += middle.s;
    }
    const double scale = std::sqrt(half_pi / b);
    return {scale * sum.c, scale * sum.s};
}

FresnelValue fresnel_between(double turns, double d, double length) {
    const double a = 4 * num::pi * turns * d, b = 2 * num::pi * turns, scale = 2 * std::sqrt(turns);
    const FresnelValue v = times(unit_of_turns(two_product(d, d) * turns), chirp_integral(a, b, length));
    return {scale * v.c, scale * v.s};
}

}  // namespace obscura
