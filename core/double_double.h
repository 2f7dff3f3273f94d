#pragma once
// Numbers as unevaluated sums of two doubles, about 106 bits, from additions and multiplications alone.
//
// T. J. Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18, 1971
// (split, product); D. E. Knuth, TAOCP vol. 2, 4.2.2 (two_sum). No FMA: the bits are the same on every CPU.
// Operands stay between 2^-500 and 2^500, where nothing overflows and error terms are exact.

namespace obscura {

/// hi + lo with |lo| <= ulp(hi) / 2.
struct Dd {
    double hi = 0, lo = 0;
};

/// a + b exactly, given |a| >= |b| or a = 0.
constexpr Dd quick_two_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
}

/// a + b exactly.
constexpr Dd two_sum(double a, double b) {
    const double s = a + b;
    const double b_part = s - a;
    return {s, (a - (s - b_part)) + (b - b_part)};
}

/// Upper 26 bits and the rest.
constexpr Dd split(double a) {
    const double t = 134217729.0 * a;  // 2^27 + 1
    const double hi = t - (t - a);
    return {hi, a - hi};
}

/// a * b exactly.
constexpr Dd two_product(double a, double b) {
    const double p = a * b;
    const Dd x = split(a), y = split(b);
    return {p, ((x.hi * y.hi - p) + x.hi * y.lo + x.lo * y.hi) + x.lo * y.lo};
}

constexpr Dd operator-(Dd a) {
    return {-a.hi, -a.lo};
}
constexpr Dd operator+(Dd a, Dd b) {
    const Dd s = two_sum(a.hi, b.hi);
    const Dd t = two_sum(a.lo, b.lo);
    const Dd u = quick_two_sum(s.hi, s.lo + t.hi);
    return quick_two_sum(u.hi, u.lo + t.lo);
}
constexpr Dd operator-(Dd a, Dd b) {
    return a + -b;
}
constexpr Dd operator*(Dd a, double b) {
    const Dd p = two_product(a.hi, b);
    return quick_two_sum(p.hi, p.lo + a.lo * b);
}
constexpr Dd operator*(Dd a, Dd b) {
    const Dd p = two_product(a.hi, b.hi);
    return quick_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}
constexpr Dd operator/(Dd a, Dd b) {
    const double q = a.hi / b.hi;
    const Dd r = a - b * q;
    return quick_two_sum(q, r.hi / b.hi);
}
/// Rounded to one double.
constexpr double rounded(Dd a) {
    return a.hi + a.lo;
}

}  // namespace obscura
