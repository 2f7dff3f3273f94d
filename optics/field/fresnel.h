#pragma once
// Fresnel integrals, and the integral of a chirp between two edges.

namespace obscura {

/// A complex number: C(t) + i S(t) = integral from 0 to t of e^(i pi x^2 / 2) dx, or a part of it.
struct FresnelValue {
    double c = 0, s = 0;
};

/// C(t) + i S(t) within 2e-15, and within 4e-16 of itself near 0; odd in t. Power series below |t| = 1.8;
/// beyond it (1 + i) / 2 - fresnel_auxiliary(t) e^(i pi t^2 / 2), whose phase is reduced exactly.
FresnelValue fresnel_integral(double t);

/// The classical cheap form, J. Boersma: Computation of Fresnel integrals, Mathematics of Computation 14,
/// 1960: two polynomials of twelve terms, parted at pi t^2 / 2 = 4. Error below 3e-9 for any t; odd in t.
FresnelValue fresnel_integral_boersma(double t);

/// g(t) + i f(t) for t >= 0, which falls smoothly from (1 + i) / 2 to i / (pi t): the Fresnel integral less
/// its limit and less its oscillation. Relative error below 1e-14 for any t.
FresnelValue fresnel_auxiliary(double t);

/// C(t) + i S(t) for t = 2 d sqrt(turns), whose phase pi t^2 / 2 is `turns` d^2 turns. The product is kept
/// to 100 bits, so the phase is right wherever d is exact, however many turns there are. turns > 0.
FresnelValue fresnel_at(double turns, double d);

/// Integral from 0 to length of e^(i (a x + b x^2)) dx for any a, b >= 0, length >= 0 (the thesis's equations
/// 3.22 and 3.23, less their lower limits, in the form that neither b -> 0 nor a of either sign spoils):
/// eight-point Gauss while the phase turns little, else the auxiliary function at both ends with the phase
/// a x + b x^2 taken directly, and sin x / x where b no longer tells. Relative error (of the integral without
/// cancellation) below 1e-13 as long as a length and b length^2 stay below 1e3.
FresnelValue chirp_integral(double a, double b, double length);

/// fresnel_at(turns, d + length) - fresnel_at(turns, d), without the cancellation that a short length, or
/// turns -> 0, would bring. length >= 0.
FresnelValue fresnel_between(double turns, double d, double length);

}  // namespace obscura
