// Fresnel integrals against quadrature in long double, limits, and the conditioning of chirp integrals.

#include "optics/field/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/num.h"

namespace obscura {
namespace {

using Complex = std::complex<long double>;

constexpr long double pi_l = 3.141592653589793238462643383279502884L;

/// Integral of e^(i phase(x)) from x0 to x1: `panels` panels of five-point Gauss-Legendre.
template <class Phase>
Complex quadrature(Phase phase, long double x0, long double x1, int panels) {
    static const long double inner = std::sqrt(5 - 2 * std::sqrt(10.0L / 7)) / 3,
                             outer = std::sqrt(5 + 2 * std::sqrt(10.0L / 7)) / 3;
    const long double nodes[] = {-outer, -inner, 0, inner, outer};
    const long double root70 = 13 * std::sqrt(70.0L);
    const long double weights[] = {(322 - root70) / 900, (322 + root70) / 900, 128.0L / 225,
                                   (322 + root70) / 900, (322 - root70) / 900};
    const long double h = (x1 - x0) / panels;
    Complex sum = 0;
    for (int p = 0; p < panels; ++p) {
        for (int k = 0; k < 5; ++k) {
            const long double angle = phase(x0 + h * (p + 0.5L + 0.5L * nodes[k]));
            sum += weights[k] * Complex(std::cos(angle), std::sin(angle));
        }
    }
    return sum * h * 0.5L;
}

long double chirp(long double x) {
    return pi_l * x * x / 2;
}

long double distance(FresnelValue a, Complex b) {
    return std::abs(Complex(a.c, a.s) - b);
}

TEST(Fresnel, AgreesWithQuadratureUpTo20) {
    Complex expected = 0;
    long double worst = 0, worst_boersma = 0, at = 0;
    for (int i = 1; i <= 4000; ++i) {
        const double t = 0.005 * i;
        expected += quadrature(chirp, at, t, 8);
        at = t;
        worst = std::max(worst, distance(fresnel_integral(t), expected));
        worst_boersma = std::max(worst_boersma, distance(fresnel_integral_boersma(t), expected));
    }
    EXPECT_LT(worst, 2e-15L);
    EXPECT_LT(worst_boersma, 3e-9L);
    // The published error is reached: the coefficients are Boersma's, not something better or worse.
    EXPECT_GT(worst_boersma, 2e-9L);
}

TEST(Fresnel, IsOddAndKeepsSmallArguments) {
    for (const double t : {1e-300, 1e-20, 1e-9, 1e-3, 0.7, 1.79999, 1.8, 3.39999, 3.4, 40.0, 1e6, 1e18}) {
        const FresnelValue a = fresnel_integral(t), b = fresnel_integral(-t);
        EXPECT_EQ(a.c, -b.c) << t;
        EXPECT_EQ(a.s, -b.s) << t;
        const FresnelValue c = fresnel_integral_boersma(t), d = fresnel_integral_boersma(-t);
        EXPECT_EQ(c.c, -d.c) << t;
        EXPECT_EQ(c.s, -d.s) << t;
    }
    for (const double t : {1e-90, 1e-20, 1e-9, 1e-5}) {
        EXPECT_NEAR(fresnel_integral(t).c / t, 1, 4e-16);
        EXPECT_NEAR(fresnel_integral(t).s / (t * t * t), num::pi / 6, 1e-15);
    }
    EXPECT_EQ(fresnel_integral(0).c, 0);
    EXPECT_EQ(fresnel_integral(1e300).c, 0.5);
    EXPECT_EQ(fresnel_integral(-1e300).s, -0.5);
}

TEST(Fresnel, PiecesMeet) {
    for (const double t : {1.8, 3.4}) {
        const FresnelValue below = fresnel_integral(std::nextafter(t, 0.0)), above = fresnel_integral(t);
        EXPECT_NEAR(below.c, above.c, 3e-15);
        EXPECT_NEAR(below.s, above.s, 3e-15);
    }
}

TEST(Fresnel, LargePhasesAreReducedExactly) {
    // t^2 = 4 k: whole turns, so that the oscillation stands at its start whatever the number of turns.
    for (const double t : {32.0, 1024.0, 1048576.0, 67108864.0}) {
        const FresnelValue v = fresnel_integral(t), tail = fresnel_auxiliary(t);
        EXPECT_EQ(v.c, 0.5 - tail.c) << t;
        EXPECT_EQ(v.s, 0.5 - tail.s) << t;
    }
    // (2^27 + 1)^2 = 4 k + 1: a quarter turn that a double of the square cannot hold.
    const FresnelValue quarter = fresnel_integral(0x1p27 + 1), small = fresnel_auxiliary(0x1p27 + 1);
    EXPECT_EQ(quarter.c, 0.5 + small.s);
    EXPECT_EQ(quarter.s, 0.5 - small.c);
    const FresnelValue same = fresnel_at(1, 0x1p26 + 0.5);
    EXPECT_EQ(same.c, quarter.c);
    EXPECT_EQ(same.s, quarter.s);
    // turns d^2 = 2^40 + 1/4: (g + i f) i.
    const FresnelValue v = fresnel_at(1 + 0x1p-42, 0x1p20), tail = fresnel_auxiliary(0x1p21);
    EXPECT_NEAR(v.c, 0.5 + tail.s, 1e-15);
    EXPECT_NEAR(v.s, 0.5 - tail.c, 1e-15);
    for (const double t : {-3.0, 0.2, 1.9, 17.3}) {
        const FresnelValue a = fresnel_at(0.25, t), b = fresnel_integral(t);
        EXPECT_NEAR(a.c, b.c, 1e-15);
        EXPECT_NEAR(a.s, b.s, 1e-15);
    }
}

TEST(Fresnel, AuxiliaryFallsLikeItsAsymptoticSeries) {
    for (const double t : {30.0, 1e3, 1e8, 1e16, 1e18}) {
        const double z = num::pi * t * t;
        const FresnelValue v = fresnel_auxiliary(t);
        EXPECT_NEAR(v.s * num::pi * t, 1 - 3 / (z * z), 1e-13 + 105 / (z * z * z * z));
        if (t < 1e17) {
            EXPECT_NEAR(v.c * num::pi * t * z, 1 - 15 / (z * z), 1e-13 + 1e3 / (z * z * z * z));
        }
    }
    EXPECT_EQ(fresnel_auxiliary(0).c, 0.5);
    EXPECT_EQ(fresnel_auxiliary(0).s, 0.5);
}

/// The cases of which differences of C and S lose up to all digits, and their neighbours.
TEST(Fresnel, ChirpIntegralsAreWellConditioned) {
    struct Case {
        double a, b, length;
    };
    const Case cases[] = {
        {-1000, 10, 1},   {-30, 1e-2, 1},    {-1, 1e-6, 1},    {0, 1e-9, 1},   {0, 0, 1},
        {1, 0, 1},        {7, 0, 1},         {-7, 1e-18, 1},   {7, 1e-16, 1},  {-7, 1e-12, 1},
        {1.2, 0.39, 1},   {1.2, 0.41, 1},    {-3, 2, 1},       {-4, 2, 1},     {-5, 2, 1},
        {-2, 100, 1},     {0, 400, 1},       {-400, 400, 1},   {-800, 400, 1}, {400, 400, 1},
        {1e-9, 1e-9, 64}, {-0.3, 0.004, 64}, {0.3, 0.004, 64}, {5, 3, 1e-9},   {-5e8, 3, 1e-9}};
    for (const Case& k : cases) {
        const auto phase = [&](long double x) { return x * (k.a + k.b * x); };
        const Complex expected = quadrature(phase, 0, k.length, 4000);
        EXPECT_LT(distance(chirp_integral(k.a, k.b, k.length), expected) / std::abs(expected), 2e-14L)
            << "a " << k.a << " b " << k.b << " length " << k.length;
    }
}

TEST(Fresnel, PaperEquationsHoldOnceTheirLowerLimitIsAdded) {
    const double a = -3, b = 2, length = 1.5;
    const double phi0 = a / std::sqrt(2 * num::pi * b),
                 phi = (a + 2 * b * length) / std::sqrt(2 * num::pi * b);
    const double angle = a * a / (4 * b), scale = std::sqrt(num::pi / (2 * b));
    const FresnelValue low = fresnel_integral(phi0), high = fresnel_integral(phi);
    const auto printed_cos = [&](double c, double s) {
        return scale * (std::cos(angle) * c + std::sin(angle) * s);
    };
    const auto printed_sin = [&](double c, double s) {
        return scale * (std::cos(angle) * s - std::sin(angle) * c);
    };
    const FresnelValue expected = chirp_integral(a, b, length);
    EXPECT_NEAR(printed_cos(high.c - low.c, high.s - low.s), expected.c, 1e-14);
    EXPECT_NEAR(printed_sin(high.c - low.c, high.s - low.s), expected.s, 1e-14);
    EXPECT_GT(std::fabs(printed_cos(high.c, high.s) - expected.c), 0.1);  // as printed
}

}  // namespace
}  // namespace obscura
