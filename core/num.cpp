#include "core/num.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/double_double.h"

// Method: reduce the argument exactly, or to a double-double, to a small interval around zero; sum the Taylor
// series there until its tail is below 2^-58 of the result; put the pieces together so that only the last
// addition rounds noticeably. Reductions: W. J. Cody and W. Waite, "Software Manual for the Elementary
// Functions", 1980 (constants cut into parts whose products with small integers are exact); J.-M. Muller,
// "Elementary Functions", 3rd ed. 2016, ch. 11. Series instead of minimax polynomials: two or three terms
// more, and every coefficient can be checked by eye.

namespace obscura::num {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

constexpr Dd pi_dd{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr Dd half_pi_dd{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr Dd degree_dd{0x1.1df46a2529d39p-6, 0x1.5c1d8becdd291p-62};  // pi / 180
constexpr Dd ln2_dd{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr Dd inv_ln2_dd{0x1.71547652b82fep+0, 0x1.777d0ffda0d24p-56};
constexpr double ln2_hi = 0x1.62e42fee00000p-1;  // 32 bits of ln 2
constexpr double ln2_lo = 0x1.a39ef35793c76p-33;

/// Nearest integer, ties to even, for |x| < 2^51.
double nearest(double x) {
    return (x + 0x1.8p52) - 0x1.8p52;
}

/// 2^k for -1022 <= k <= 1023.
double power_of_two(int k) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

/// y * 2^k for 0.5 <= y <= 2, rounded once; overflows to infinity, underflows gradually to zero.
double scaled(double y, int k) {
    if (k > 1023) return k > 1025 ? inf : y * 0x1p1023 * power_of_two(k - 1023);
    if (k >= -1020) return y * power_of_two(k);
    return k < -1080 ? 0.0 : y * power_of_two(k + 128) * 0x1p-128;
}

struct Binary {
    double mantissa;  ///< in [1, 2)
    int exponent;
};

/// Splits a finite x > 0.
Binary binary(double x) {
    const int shift = x < 0x1p-1022 ? 54 : 0;
    const auto bits = std::bit_cast<std::uint64_t>(shift ? x * 0x1p54 : x);
    const auto mantissa = std::bit_cast<double>((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u);
    return {mantissa, static_cast<int>(bits >> 52) - 1023 - shift};
}

// --- trigonometric -----------------------------------------------------------------------------------

/// An angle as quadrant * pi/2 + rest, |rest| <= pi/4 and a little.
struct Turned {
    int quadrant;
    Dd rest;
};

Turned reduce(double x) {
    if (std::fabs(x) > 0x1p20) x = std::fmod(x, 2 * pi);  // fmod is exact
    if (std::fabs(x) <= 0.785) return {0, {x, 0}};

    // pi/2 in parts of 33 bits: n has at most 20, so the first three products are exact, and so is the first
    // difference. What is left of pi/2 after three parts only matters below 2^-84.
    const double n = nearest(x * 0x1.45f306dc9c883p-1);
    Dd rest = two_sum(x - n * 0x1.921fb54400000p+0, -(n * 0x1.0b4611a600000p-34));
    rest = rest + Dd{-(n * 0x1.3198a2e000000p-69), -(n * 0x1.b839a252049c1p-104)};
    return {static_cast<int>(static_cast<std::int64_t>(n) & 3), rest};
}

Turned reduce_deg(double x) {
    const double within = std::fmod(x, 360.0);
    const double n = nearest(within / 90.0);
    return {static_cast<int>(n) & 3, degree_dd * (within - n * 90.0)};
}

/// Sine of |r| <= pi/4 and a little: r - r^3/3! + ... + r^17/17!.
Dd sin_near_zero(Dd r) {
    const double z = r.hi * r.hi;
    double p = 1.0 / 355687428096000.0;
    p = p * z - 1.0 / 1307674368000.0;
    p = p * z + 1.0 / 6227020800.0;
    p = p * z - 1.0 / 39916800.0;
    p = p * z + 1.0 / 362880.0;
    p = p * z - 1.0 / 5040.0;
    p = p * z + 1.0 / 120.0;
    p = p * z - 1.0 / 6.0;
    return quick_two_sum(r.hi, r.lo * (1.0 - 0.5 * z) + r.hi * z * p);
}

/// Cosine of |r| <= pi/4 and a little: 1 - r^2/2! + ... + r^18/18!.
Dd cos_near_zero(Dd r) {
    const Dd square = two_product(r.hi, r.hi);
    const double z = square.hi;
    double p = -1.0 / 6402373705728000.0;
    p = p * z + 1.0 / 20922789888000.0;
    p = p * z - 1.0 / 87178291200.0;
    p = p * z + 1.0 / 479001600.0;
    p = p * z - 1.0 / 3628800.0;
    p = p * z + 1.0 / 40320.0;
    p = p * z - 1.0 / 720.0;
    p = p * z + 1.0 / 24.0;
    const Dd head = quick_two_sum(1.0, -0.5 * z);
    return quick_two_sum(head.hi, head.lo + (z * z * p - 0.5 * square.lo - r.hi * r.lo));
}

Dd sin_turned(Turned t) {
    const Dd s = (t.quadrant & 1) ? cos_near_zero(t.rest) : sin_near_zero(t.rest);
    return (t.quadrant & 2) ? -s : s;
}

Dd cos_turned(Turned t) {
    return sin_turned({(t.quadrant + 1) & 3, t.rest});
}

// --- inverse trigonometric ---------------------------------------------------------------------------

constexpr Dd atan_of_eighths[9] = {
    {0.0, 0.0},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};

/// atan(s / c) for 0 <= s <= c, c > 0: atan(i/8) + atan(t), t = (s - c i/8) / (c + s i/8), |t| <= 1/16.
Dd atan_ratio(Dd s, Dd c) {
    const double i = nearest(8.0 * (s.hi / c.hi));
    const Dd t = (s - c * (i / 8)) / (c + s * (i / 8));
    const double z = t.hi * t.hi;
    double p = -1.0 / 15.0;
    p = p * z + 1.0 / 13.0;
    p = p * z - 1.0 / 11.0;
    p = p * z + 1.0 / 9.0;
    p = p * z - 1.0 / 7.0;
    p = p * z + 1.0 / 5.0;
    p = p * z - 1.0 / 3.0;
    const Dd small = quick_two_sum(t.hi, t.lo + t.hi * z * p);
    return atan_of_eighths[static_cast<int>(i)] + small;
}

/// Angle of the vector (c, s) in the first quadrant; not both zero.
Dd first_quadrant(Dd s, Dd c) {
    return s.hi <= c.hi ? atan_ratio(s, c) : half_pi_dd - atan_ratio(c, s);
}

/// sqrt(1 - x^2), without the cancellation near 1.
Dd other_leg(double x) {
    const Dd square = two_sum(1.0, -x) * two_sum(1.0, x);
    if (square.hi <= 0) return {};
    const double root = std::sqrt(square.hi);
    const Dd rest = square - two_product(root, root);
    return quick_two_sum(root, rest.hi / (2 * root));
}

// --- exponential and logarithm ------------------------------------------------------------------------

/// exp(x.hi + x.lo) for -750 < x < 750.
double exp_dd(Dd x) {
    // x = k ln 2 + r, |r| <= 0.35; k * ln2_hi is exact.
    const double k = nearest(x.hi * inv_ln2_dd.hi);
    const Dd r = two_sum(x.hi - k * ln2_hi, x.lo - k * ln2_lo);

    // 1 + r + r^2/2! + ... + r^14/14!
    double p = 1.0 / 87178291200.0;
    p = p * r.hi + 1.0 / 6227020800.0;
    p = p * r.hi + 1.0 / 479001600.0;
    p = p * r.hi + 1.0 / 39916800.0;
    p = p * r.hi + 1.0 / 3628800.0;
    p = p * r.hi + 1.0 / 362880.0;
    p = p * r.hi + 1.0 / 40320.0;
    p = p * r.hi + 1.0 / 5040.0;
    p = p * r.hi + 1.0 / 720.0;
    p = p * r.hi + 1.0 / 120.0;
    p = p * r.hi + 1.0 / 24.0;
    p = p * r.hi + 1.0 / 6.0;
    p = p * r.hi + 0.5;
    const Dd head = quick_two_sum(1.0, r.hi);
    return scaled(head.hi + (head.lo + (r.lo + r.hi * r.hi * p)), static_cast<int>(k));
}

/// log(x) of a finite x > 0, to about 68 bits.
Dd log_dd(double x) {
    // x = 2^k m with m around 1, so that k = 0 next to 1 and nothing cancels there.
    Binary b = binary(x);
    if (b.mantissa > 0x1.6a09e667f3bcdp+0) {
        b.mantissa *= 0.5;
        b.exponent += 1;
    }

    // log m = 2 atanh(s) = 2 s (1 + z/3 + z^2/5 + ...), s = (m - 1) / (m + 1), z = s^2 <= 0.0295.
    // The first three terms in double-double, the tail in double.
    const Dd s = Dd{b.mantissa - 1.0, 0.0} / two_sum(b.mantissa, 1.0);
    const Dd z = s * s;
    double tail = 1.0 / 27.0;
    for (int odd = 25; odd >= 7; odd -= 2)
        tail = tail * z.hi + 1.0 / odd;
    constexpr Dd third{0x1.5555555555555p-2, 0x1.5555555555555p-56};
    constexpr Dd fifth{0x1.999999999999ap-3, -0x1.999999999999ap-57};
    const Dd series = Dd{1.0, 0.0} + z * (third + z * (fifth + z * tail));
    const Dd log_m = (s * 2.0) * series;

    const double k = b.exponent;
    return two_sum(k * ln2_hi, k * ln2_lo) + log_m;
}

/// NaN, zero, negative and infinite arguments of a logarithm.
double log_special(double x) {
    if (x == 0) return -inf;
    return x > 0 ? x : nan;
}

bool is_positive_finite(double x) {
    return x > 0 && x < inf;
}

bool is_integer(double x) {
    return std::floor(x) == x;
}

bool is_odd(double x) {
    return is_integer(x) && std::fabs(x) < 0x1p53 && !is_integer(0.5 * x);
}

/// |x|^y where x is 0 or infinite, or y is infinite; y != 0, |x| != 1, no NaN.
double pow_limit(double magnitude, double y) {
    const bool grows = (magnitude > 1) == (y > 0);
    return grows ? inf : 0.0;
}

}  // namespace

double sin(double x) {
    if (!(std::fabs(x) < inf)) return nan;
    if (std::fabs(x) < 0x1p-27) return x;
    return rounded(sin_turned(reduce(x)));
}

double cos(double x) {
    if (!(std::fabs(x) < inf)) return nan;
    return rounded(cos_turned(reduce(x)));
}

double tan(double x) {
    if (!(std::fabs(x) < inf)) return nan;
    if (std::fabs(x) < 0x1p-27) return x;
    const Turned t = reduce(x);
    return rounded(sin_turned(t) / cos_turned(t));
}

double sin_deg(double x) {
    if (!(std::fabs(x) < inf)) return nan;
    if (std::fabs(x) < 0x1p-27) return x * degree_dd.hi;
    return rounded(sin_turned(reduce_deg(x)));
}

double cos_deg(double x) {
    if (!(std::fabs(x) < inf)) return nan;
    return rounded(cos_turned(reduce_deg(x)));
}

double asin(double x) {
    if (!(std::fabs(x) <= 1)) return nan;
    if (std::fabs(x) < 0x1p-27) return x;
    return std::copysign(rounded(first_quadrant({std::fabs(x), 0}, other_leg(x))), x);
}

double acos(double x) {
    if (!(std::fabs(x) <= 1)) return nan;
    const Dd angle = first_quadrant(other_leg(x), {std::fabs(x), 0});
    return rounded(x < 0 ? pi_dd - angle : angle);
}

double atan(double x) {
    const double size = std::fabs(x);
    if (size < 0x1p-27 || x != x) return x;
    if (size > 0x1p60) return std::copysign(half_pi_dd.hi, x);
    return std::copysign(rounded(first_quadrant({size, 0}, {1.0, 0})), x);
}

double atan2(double y, double x) {
    if (x != x || y != y) return nan;
    const bool left = std::signbit(x);
    double s = std::fabs(y), c = std::fabs(x);
    if (s == 0) return std::copysign(left ? pi : 0.0, y);
    if (c == 0) return std::copysign(half_pi_dd.hi, y);
    if (s == inf || c == inf) {  // infinities count as equally long
        s = s == inf ? 1.0 : 0.0;
        c = c == inf ? 1.0 : 0.0;
        if (s == 0) return std::copysign(left ? pi : 0.0, y);
    } else {
        const Binary bs = binary(s), bc = binary(c);
        const int apart = bs.exponent - bc.exponent;
        if (apart > 60) return std::copysign(half_pi_dd.hi, y);
        if (apart < -60) return std::copysign(left ? pi : s / c, y);
        s = bs.mantissa * power_of_two(apart);
        c = bc.mantissa;
    }
    const Dd angle = first_quadrant({s, 0}, {c, 0});
    return std::copysign(rounded(left ? pi_dd - angle : angle), y);
}

double exp(double x) {
    if (x != x) return x;
    if (x > 710) return inf;
    if (x < -746) return 0.0;
    return exp_dd({x, 0});
}

double exp2(double x) {
    if (x != x) return x;
    if (x >= 1024) return inf;
    if (x < -1076) return 0.0;
    const double k = nearest(x);
    return scaled(exp_dd(ln2_dd * (x - k)), static_cast<int>(k));
}

double log(double x) {
    return is_positive_finite(x) ? rounded(log_dd(x)) : log_special(x);
}

double log2(double x) {
    if (!is_positive_finite(x)) return log_special(x);
    const Binary b = binary(x);
    if (b.mantissa == 1.0) return b.exponent;
    // Whole part apart, unless that would cancel next to 1.
    const bool upper = b.mantissa > 0x1.6a09e667f3bcdp+0;
    const double k = b.exponent + (upper ? 1 : 0);
    const Dd fraction = log_dd(upper ? 0.5 * b.mantissa : b.mantissa) * inv_ln2_dd;
    return rounded(Dd{k, 0} + fraction);
}

double pow(double x, double y) {
    if (y == 0 || x == 1) return 1.0;
    if (x != x || y != y) return nan;
    const double magnitude = std::fabs(x);
    const bool negative = std::signbit(x) && is_odd(y);
    if (magnitude == 0 || magnitude == inf || std::fabs(y) == inf) {
        if (magnitude == 1) return 1.0;
        const double limit = pow_limit(magnitude, y);
        return negative ? -limit : limit;
    }
    if (x < 0 && !is_integer(y)) return nan;

    // |log x| is 2^-53 at least (or 0), so an exponent beyond 2^64 decides alone and may be cut there.
    const double bounded = std::fabs(y) > 0x1p64 ? std::copysign(0x1p64, y) : y;
    const Dd exponent = log_dd(magnitude) * bounded;
    const double result = exponent.hi > 710 ? inf : (exponent.hi < -746 ? 0.0 : exp_dd(exponent));
    return negative ? -result : result;
}

double cbrt(double x) {
    if (x == 0 || !(std::fabs(x) < inf)) return x;
    // |x| = m * 8^q, m in [1, 8): Newton from a straight line, the last step with an exact residual.
    const Binary b = binary(std::fabs(x));
    const int q = (b.exponent + 3000) / 3 - 1000;
    const double m = b.mantissa * power_of_two(b.exponent - 3 * q);
    double y = 1.07 + (m - 1.0) / 7.0;
    for (int step = 0; step < 4; ++step)
        y -= (y * y * y - m) / (3.0 * y * y);
    const Dd cube = two_product(y, y) * y;
    y += ((m - cube.hi) - cube.lo) / (3.0 * y * y);
    return std::copysign(y * power_of_two(q), x);
}

}  // namespace obscura::num
