#pragma once
// Fresnel integrals, and the integral of a chirp between two edges.

namespace obscura {

/// C(t) + i S(t) = integral from 0 to t of e^(i pi x^2 / 2) dx.
struct FresnelValue {
    double c = 0, s = 0;
};

/// J. Boersma: Computation of Fresnel integrals, Mathematics of Computation 14, 1960. Error below 3e-9 for
/// any t; odd in t.
FresnelValue fresnel_integral(double t);

}  // namespace obscura
